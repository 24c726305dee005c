// Functions of the mathematical library, lane by lane.
template <double (*function)(double)>
inline double library(double x) {
  return function(x);
}
template <double (*function)(double, double)>
inline double library(double x, double y) {
  return function(x, y);
}
template <double (*function)(double), int W>
inline Pack<W> library(const Pack<W>& a) {
  double x[W];
  a.copy_to(x);
  for (double& number : x) number = function(number);
  return Pack<W>(x);
}
template <double (*function)(double, double), int W>
inline Pack<W> library(const Pack<W>& a, const Pack<W>& b) {
  double x[W];
  double y[W];
  a.copy_to(x);
  b.copy_to(y);
  for (int lane = 0; lane < W; ++lane) x[lane] = function(x[lane], y[lane]);
  return Pack<W>(x);
}
template <double (*function)(double, double), int W>
inline Pack<W> library(const Pack<W>& a, double b) {
  return library<function>(a, Pack<W>(b));
}
template <double (*function)(double, double), int W>
inline Pack<W> library(double a, const Pack<W>& b) {
  return library<function>(Pack<W>(a), b);
}
