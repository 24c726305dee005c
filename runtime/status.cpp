#include "runtime/status.hpp"

namespace hamgen::runtime {

std::string_view to_text(Status status) {
  switch (status) {
    case Status::done:
      return "done";
    case Status::jumped:
      return "jumped";
    case Status::escaped:
      return "escaped";
    case Status::not_converged:
      return "not converged";
    case Status::left_domain:
      return "left the domain";
    case Status::overflow:
      return "overflow";
    case Status::stopped:
      return "stopped";
    case Status::out_of_time:
      return "out of time";
    case Status::undefined:
      return "undefined";
  }
  return {};
}

}  // namespace hamgen::runtime
