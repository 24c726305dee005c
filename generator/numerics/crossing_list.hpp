// The crossings of several events in a step, in the order of time.
template <int Events>
struct CrossingList {
  int event[10 * Events] = {};
  Real theta[10 * Events] = {};
  int count = 0;

  void insert(int number, Real at) {
    int place = count++;
    for (; place > 0 && theta[place - 1] > at; --place) {
      event[place] = event[place - 1];
      theta[place] = theta[place - 1];
    }
    event[place] = number;
    theta[place] = at;
  }
};
