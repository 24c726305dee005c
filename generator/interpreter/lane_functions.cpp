#include "generator/interpreter/lane_functions.hpp"

#include <map>

namespace hamgen {

namespace lanes_of_one {
#include "generator/interpreter/lanes.inc"
}  // namespace lanes_of_one

namespace {

template <double (*function)(double)>
double of_one(double x, double) {
  return function(x);
}

const std::map<std::string, double (*)(double, double)>& table() {
  using namespace lanes_of_one;
  static const std::map<std::string, double (*)(double, double)> functions = {
      {"abs", of_one<lane_abs<double>>},
      {"acos", of_one<lane_acos<double>>},
      {"acosh", of_one<lane_acosh<double>>},
      {"asin", of_one<lane_asin<double>>},
      {"asinh", of_one<lane_asinh<double>>},
      {"atan", of_one<lane_atan<double>>},
      {"atan2", lane_atan2<double>},
      {"atanh", of_one<lane_atanh<double>>},
      {"cos", of_one<lane_cos<double>>},
      {"cosh", of_one<lane_cosh<double>>},
      {"exp", of_one<lane_exp<double>>},
      {"log", of_one<lane_log<double>>},
      {"pow", lane_pow<double>},
      {"sin", of_one<lane_sin<double>>},
      {"sinh", of_one<lane_sinh<double>>},
      {"sqrt", of_one<lane_sqrt<double>>},
      {"tan", of_one<lane_tan<double>>},
      {"tanh", of_one<lane_tanh<double>>},
  };
  return functions;
}

}  // namespace

double (*lane_function(const std::string& name))(double, double) {
  const auto found = table().find(name);
  return found == table().end() ? nullptr : found->second;
}

}  // namespace hamgen
