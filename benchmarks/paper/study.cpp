#include "benchmarks/paper/study.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "generator/pipeline.hpp"
#include "runtime/atomic_file.hpp"

namespace hamgen::paper {

Study make_study(bool quick, const std::filesystem::path& data) {
  Study study{.quick = quick, .data = data};
  const Request family{.alpha = "alpha", .beta = "beta", .gamma = "gamma"};
  Request sweeps = family;
  sweeps.solver = "sweeps:5";
  Request extended = family;
  extended.scalar = "long-double";
  study.member = compile_scheme("member", family);
  study.sweeps = compile_scheme("member, kappa = 5", sweeps);
  study.extended = compile_scheme("member", extended);
  study.euler_a = compile_scheme("symplectic Euler A", {.scheme = "symplectic-euler-a"});
  study.euler_b = compile_scheme("symplectic Euler B", {.scheme = "symplectic-euler-b"});
  study.reference = compile_scheme("reference", {.scalar = "quad"});
  const auto named = [](const char* name, const char* scheme, const char* scalar) {
    return compile_scheme(name, {.scheme = scheme, .scalar = scalar});
  };
  study.splittings = {named("SABA2 as printed", "saba-2-printed", "long-double"),
                      named("SABA2", "saba-2", "long-double")};
  for (const int order : {4, 6, 8}) {
    Request raised;
    raised.order = order;
    raised.scalar = "long-double";
    study.orders.push_back(compile_scheme(fmt::format("order {}", order), raised));
  }
  study.timed = {compile_scheme("midpoint rule, kappa = 5", {.solver = "sweeps:5"}),
                 compile_scheme("midpoint rule, solved by Newton", {}),
                 named("SABA2 as printed", "saba-2-printed", "double")};
  return study;
}

void DataTable::block(const std::string& title) {
  text_ += fmt::format("{}# {}\n", text_.empty() ? "" : "\n\n", title);
}

void DataTable::row(const std::vector<long double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    text_ += fmt::format("{}{:.10g}", i == 0 ? "" : " ", static_cast<double>(values[i]));
  text_ += "\n";
}

void DataTable::empty_line() { text_ += "\n"; }

void DataTable::write(const std::filesystem::path& path) const {
  runtime::AtomicFile file(path);
  file.write(text_);
  file.publish();
}

Orbit trace(DataTable& data, const std::string& title, const CompiledScheme& scheme,
            const Start& start, long steps, long points) {
  const long every = std::max(1L, steps / points);
  data.block(title);
  long step = 0;
  return integrate(scheme, start, steps, [&](const Sample& sample) {
    if (step++ % every == 0) data.row({sample.t, sample.error});
  });
}

}  // namespace hamgen::paper
