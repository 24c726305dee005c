// Crossings of zero of a quantity within a step.  Each is the root in theta, from 0 to 1, of the
// quantity after one step of length theta h from the state before, so that it has the order of the
// steps, whatever brackets it.
//
// Note [several crossings in a step]
// The signs at both ends tell of an odd number of them only.  Between them the state is taken from
// the cubic through both states and their derivatives J grad H, with an error of order h^4, which
// costs no step; where its signs change, or it comes near zero and turns, the sign is that after a
// part of the step.  What the cubic misses, a touch of zero by less than its error, is not found.

// The cubic in s, from 0 to 1, with these values at its ends and these derivatives by the time.
inline Real cubic_between(Real s, Real h, Real before, Real slope_before, Real after,
                          Real slope_after) {
  const Real r = 1 - s;
  return (1 + 2 * s) * r * r * before + s * r * r * h * slope_before + s * s * (1 + 2 * r) * after -
         s * s * r * h * slope_after;
}

// Where look(s), of this sign, is closest to zero between a and b, about: golden section.
template <class Look>
Real closest_to_zero(const Look& look, Real sign, Real a, Real b) {
  constexpr Real golden = Real(0.6180339887498949);
  Real left = b - golden * (b - a);
  Real right = a + golden * (b - a);
  Real at_left = sign * look(left);
  Real at_right = sign * look(right);
  for (int i = 0; i < 24; ++i) {
    if (at_left < at_right) {
      b = right;
      right = left;
      at_right = at_left;
      left = b - golden * (b - a);
      at_left = sign * look(left);
    } else {
      a = left;
      left = right;
      at_left = at_right;
      right = a + golden * (b - a);
      at_right = sign * look(right);
    }
  }
  return (a + b) / 2;
}

// Writes where inside the step the sign may be another than at both ends, and returns how many
// there are.  look(s): the quantity on the cubic.
template <class Look>
int suspected_crossings(const Look& look, Real before, Real after, Real (&result)[9]) {
  const Real middle = look(Real(1) / 2);
  Real low = before < after ? before : after;
  Real high = before < after ? after : before;
  if (middle < low) low = middle;
  if (middle > high) high = middle;
  // Far from zero beside how it changes: nothing to be seen between.
  if (low > 2 * (high - low) || -high > 2 * (high - low)) return 0;
  // Close to both ends too, for a turn next to them.
  constexpr int places[11] = {0, 1, 4, 8, 12, 16, 20, 24, 28, 31, 32};
  Real s[11];
  Real value[11];
  Real most = 0;
  for (int i = 0; i < 11; ++i) {
    s[i] = Real(places[i]) / 32;
    value[i] = i == 0 ? before : i == 10 ? after : look(s[i]);
    if (magnitude(value[i]) > most) most = magnitude(value[i]);
  }
  const auto same_sign = [&](int i, int j) {
    return (value[i] > 0 && value[j] > 0) || (value[i] < 0 && value[j] < 0);
  };
  int count = 0;
  for (int i = 1; i < 10; ++i) {
    if (!same_sign(i, i - 1) || !same_sign(i, i + 1)) {
      result[count++] = s[i];
      continue;
    }
    const Real here = magnitude(value[i]);
    if (here > magnitude(value[i - 1]) || here > magnitude(value[i + 1])) continue;
    const Real sign = value[i] > 0 ? 1 : -1;
    const Real turn = closest_to_zero(look, sign, s[i - 1], s[i + 1]);
    if (20 * sign * look(turn) < most) result[count++] = turn;
  }
  return count;
}

// Calls found(theta) for each crossing in the directions that count, in the order of time; a value
// of zero belongs to what ends there.  `before` and `after` are the values at both ends;
// value(theta, result): that after a part of the step, false where this fails or has none, and then
// what it brackets is left out; look(s): that on the cubic.
template <class Value, class Look, class Found>
void find_crossings(const Value& value, const Look& look, Real before, Real after, bool rising,
                    bool falling, const Found& found) {
  if (!(magnitude(before) <= largest && magnitude(after) <= largest)) return;
  Real inside[9];
  const int suspects = suspected_crossings(look, before, after, inside);
  Real low = 0;
  Real at_low = before;
  for (int i = 0; i <= suspects; ++i) {
    const bool last = i == suspects;
    const Real high = last ? Real(1) : inside[i];
    Real at_high = after;
    if (!last && !value(high, at_high)) continue;
    const bool rises = at_low < 0 && at_high >= 0;
    const bool falls = at_low > 0 && at_high <= 0;
    if ((rises && rising) || (falls && falling)) {
      bool failed = false;
      const auto after_part = [&](Real theta) {
        Real result = at_high;
        if (!value(theta, result)) failed = true;
        return result;
      };
      const Real theta =
          last && at_high == 0 ? Real(1) : bracketed_root(after_part, low, at_low, high, at_high);
      if (!failed) found(theta);
    }
    low = high;
    at_low = at_high;
  }
}
