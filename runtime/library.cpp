#include "runtime/library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <stdexcept>

#include "runtime/arithmetic.hpp"
#include "runtime/object_file.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::runtime {
namespace {

[[noreturn]] void throw_not_loaded(const std::filesystem::path& object, const std::string& reason) {
  throw ToolError({.message = fmt::format("cannot load '{}': {}", object.string(), reason)});
}

bool is_complete(const hamgen_plugin& plugin) {
  return plugin.degrees_of_freedom > 0 && plugin.parameter_count >= 0 &&
         plugin.invariant_count >= 0 && plugin.description != nullptr && plugin.solver != nullptr &&
         plugin.create != nullptr && plugin.destroy != nullptr && plugin.advance != nullptr &&
         plugin.get_state != nullptr && plugin.get_carry != nullptr && plugin.energy != nullptr &&
         (plugin.invariants != nullptr || plugin.invariant_count == 0) &&
         plugin.gradient != nullptr;
}

// Their hi and their lo, as a plugin takes them.
struct Parts {
  explicit Parts(std::span<const Wide> values) {
    for (const Wide& value : values) {
      hi.push_back(value.hi);
      lo.push_back(value.lo);
    }
  }
  std::vector<double> hi;
  std::vector<double> lo;
};

}  // namespace

void Library::Close::operator()(void* handle) const { ::dlclose(handle); }

Library::Library(const hamgen_plugin& plugin, std::shared_ptr<const void> owner)
    : owner_(std::move(owner)), plugin_(&plugin) {
  if (!environment_is_ieee())
    throw_not_loaded("(a table of functions)",
                     "this thread does not round to nearest, or takes subnormal numbers for zero\n"
                     "help: fesetenv(FE_DFL_ENV) before integrators are run");
  if (plugin.version != HAMGEN_PLUGIN_VERSION || !is_complete(plugin))
    throw_not_loaded("(a table of functions)",
                     "it is of another version, or functions are missing");
}

Library::Library(const std::filesystem::path& object) {
  if (!environment_is_ieee())
    throw_not_loaded(object,
                     "this thread does not round to nearest, or takes subnormal numbers for zero\n"
                     "help: fesetenv(FE_DFL_ENV) before integrators are loaded and run");
  if (const std::string problem = object_problem(object); !problem.empty())
    throw_not_loaded(object, problem);
  bool is_ieee_after = false;
  {
    // The object may have been linked with code that changes the environment as it is loaded, as
    // the compilers do for -ffast-math.
    const KeptEnvironment kept;
    // Without a slash dlopen would search the system's directories.
    handle_.reset(::dlopen(std::filesystem::absolute(object).c_str(), RTLD_NOW | RTLD_LOCAL));
    is_ieee_after = environment_is_ieee();
  }
  if (!handle_) {
    const char* const reason = ::dlerror();
    throw_not_loaded(object, reason != nullptr ? reason : "unknown reason");
  }
  if (!is_ieee_after) {
    throw_not_loaded(object,
                     "it makes subnormal numbers zero or changes the rounding in the whole "
                     "program: its compiler adds -ffast-math, -Ofast or parts of them\n"
                     "help: compile it without them");
  }
  void* const symbol = ::dlsym(handle_.get(), "hamgen_plugin_entry");
  if (symbol == nullptr) throw_not_loaded(object, "it is no hamgen plugin");
  plugin_ = reinterpret_cast<hamgen_plugin_entry_type>(symbol)();
  if (plugin_ == nullptr) {
    throw_not_loaded(object,
                     "its table of functions is missing: it was compiled with flags that change "
                     "what the arithmetic means, so that sums, quotients, signed zeros or NaN are "
                     "not those of IEEE 754\n"
                     "help: compile it without -ffast-math, -Ofast and parts of them");
  }
  // The version comes first: the other fields mean something only if it is ours.
  if (plugin_->version != HAMGEN_PLUGIN_VERSION) {
    throw_not_loaded(object,
                     fmt::format("it has version {} of the plugin interface, this program has {}",
                                 plugin_->version, HAMGEN_PLUGIN_VERSION));
  }
  if (!is_complete(*plugin_)) throw_not_loaded(object, "its table of functions is incomplete");
}

Library::~Library() = default;

std::size_t Library::degrees_of_freedom() const {
  return static_cast<std::size_t>(plugin_->degrees_of_freedom);
}

std::size_t Library::parameter_count() const {
  return static_cast<std::size_t>(plugin_->parameter_count);
}

std::size_t Library::invariant_count() const {
  return static_cast<std::size_t>(plugin_->invariant_count);
}

void Library::check_sizes(std::size_t parameters, std::size_t state) const {
  if (parameters != parameter_count()) {
    throw std::invalid_argument(fmt::format("{} parameters were given, {} takes {}", parameters,
                                            plugin_->description, parameter_count()));
  }
  if (state != 2 * degrees_of_freedom()) {
    throw std::invalid_argument(fmt::format("a state of {} values was given, {} has {}", state,
                                            plugin_->description, 2 * degrees_of_freedom()));
  }
}

bool Library::is_wide() const { return plugin_->scalar_digits > 53; }

Wide Library::energy(std::span<const Wide> parameters, std::span<const Wide> state) const {
  check_sizes(parameters.size(), state.size());
  const Parts par(parameters);
  const Parts z(state);
  Wide energy;
  energy.hi = plugin_->energy(par.hi.data(), par.lo.data(), z.hi.data(), z.lo.data(), &energy.lo);
  return energy;
}

std::vector<Wide> Library::invariants(std::span<const Wide> parameters,
                                      std::span<const Wide> state) const {
  check_sizes(parameters.size(), state.size());
  if (invariant_count() == 0) return {};
  const Parts par(parameters);
  const Parts z(state);
  std::vector<double> hi(invariant_count());
  std::vector<double> lo(invariant_count());
  plugin_->invariants(par.hi.data(), par.lo.data(), z.hi.data(), z.lo.data(), hi.data(), lo.data());
  std::vector<Wide> values(hi.size());
  for (std::size_t i = 0; i < hi.size(); ++i) values[i] = {.hi = hi[i], .lo = lo[i]};
  return values;
}

double Library::energy(std::span<const double> parameters, std::span<const double> state) const {
  check_sizes(parameters.size(), state.size());
  return plugin_->energy(parameters.data(), nullptr, state.data(), nullptr, nullptr);
}

std::vector<double> Library::invariants(std::span<const double> parameters,
                                        std::span<const double> state) const {
  check_sizes(parameters.size(), state.size());
  std::vector<double> values(invariant_count());
  if (!values.empty())
    plugin_->invariants(parameters.data(), nullptr, state.data(), nullptr, values.data(), nullptr);
  return values;
}

std::vector<double> Library::gradient(std::span<const double> parameters,
                                      std::span<const double> state) const {
  check_sizes(parameters.size(), state.size());
  std::vector<double> values(state.size());
  plugin_->gradient(parameters.data(), state.data(), values.data());
  return values;
}

}  // namespace hamgen::runtime
