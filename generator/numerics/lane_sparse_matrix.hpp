// The numbers of a band whose width is found.
template <int Size>
class WideStorage {
 public:
  void set_width(int bandwidth) {
    width_ = bandwidth;
    entry_.resize(Size * (3 * std::size_t(width_) + 1), Real(0));
    factor_.resize(Size * std::size_t(width_), Real(0));
  }

 protected:
  int width() const { return width_; }
  void clear_entries() {
    for (Real& value : entry_) value = 0;
  }
  Real& at(int row, int column) { return entry_[place(row, column)]; }
  const Real& at(int row, int column) const { return entry_[place(row, column)]; }
  Real& factor(int c, int k) { return factor_[std::size_t(c * width_ + k)]; }
  const Real& factor(int c, int k) const { return factor_[std::size_t(c * width_ + k)]; }

 private:
  std::size_t place(int row, int column) const {
    return std::size_t(row) * (3 * std::size_t(width_) + 1) + std::size_t(column - row + width_);
  }
  int width_ = 0;
  std::vector<Real> entry_, factor_;
};
// A sparse matrix in each lane that is filled again and again by the same entries.  The first
// filling finds an order of the unknowns in which they lie near the diagonal, that of Cuthill and
// McKee: beginning far out, neighbours after neighbours.  It is eliminated as a band.
template <int Size>
class SparseMatrix {
 public:
  static constexpr int size = Size;
  void clear() {
    entries_.clear();
    if (known_) band_.clear();
  }
  void put(int row, int column, const Real& value) {
    if (known_) {
      band_.put(row_[row], row_[column], value);
    } else {
      entries_.push_back({row, column, value});
    }
  }
  // False in lanes whose matrix is singular or not finite.
  Mask factorise() {
    if (!known_) {
      find_order();
      for (const Entry& entry : entries_) put(entry.row, entry.column, entry.value);
      entries_.clear();
    }
    return band_.factorise();
  }
  void solve(Real (&vector)[size]) {
    for (int i = 0; i < size; ++i) ordered_[row_[i]] = vector[i];
    band_.solve(ordered_);
    for (int i = 0; i < size; ++i) vector[i] = ordered_[row_[i]];
  }
  void take(const Mask& lanes, const SparseMatrix& from) {
    if (!known_) {
      for (int i = 0; i < size; ++i) row_[i] = from.row_[i];
      band_.set_width(from.width_);
      known_ = true;
    }
    band_.take(lanes, from.band_);
  }

 private:
  struct Entry {
    int row, column;
    Real value;
  };
  using Lists = std::vector<std::vector<int>>;

  void find_order() {
    Lists neighbours(size);
    const auto link = [&](int i, int k) {
      std::vector<int>& list = neighbours[std::size_t(i)];
      if (i != k && std::find(list.begin(), list.end(), k) == list.end()) list.push_back(k);
    };
    for (const Entry& entry : entries_) {
      link(entry.row, entry.column);
      link(entry.column, entry.row);
    }
    const auto fewer = [&](int i, int k) {
      return neighbours[std::size_t(i)].size() < neighbours[std::size_t(k)].size();
    };
    for (std::vector<int>& list : neighbours) std::stable_sort(list.begin(), list.end(), fewer);
    int next = 0;
    for (int& row : row_) row = -1;
    for (int i = 0; i < size; ++i) {
      if (row_[i] >= 0) continue;
      for (const int unknown : reached_from(reached_from(i, neighbours).back(), neighbours))
        row_[unknown] = next++;
    }
    for (const Entry& entry : entries_) {
      const int way = row_[entry.row] - row_[entry.column];
      width_ = std::max(width_, std::max(way, -way));
    }
    band_.set_width(width_);
    known_ = true;
  }
  // The nearest first.
  std::vector<int> reached_from(int first, const Lists& neighbours) const {
    std::vector<int> reached = {first};
    std::vector<bool> is_reached(size);
    is_reached[std::size_t(first)] = true;
    for (std::size_t i = 0; i < reached.size(); ++i) {
      for (const int k : neighbours[std::size_t(reached[i])]) {
        if (!is_reached[std::size_t(k)]) reached.push_back(k);
        is_reached[std::size_t(k)] = true;
      }
    }
    return reached;
  }

  bool known_ = false;
  int row_[size] = {};  // of an unknown in the band
  int width_ = 0;
  std::vector<Entry> entries_;
  BandElimination<size, WideStorage<size>> band_;
  Real ordered_[size] = {};
};
