// As if no step had been recorded, in place: a large History makes no temporary on the stack.
template <int Unknowns>
void forget(History<Unknowns>& history) {
  history.known = 0;
  history.best = 0;
  history.age = 15;
}
