#include "generator/language/read_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "generator/language/check_names.hpp"
#include "generator/language/check_scene.hpp"
#include "generator/language/check_values.hpp"
#include "generator/language/declarations.hpp"
#include "generator/language/parser.hpp"
#include "generator/language/scene.hpp"
#include "generator/language/words.hpp"
#include "generator/language/written_out.hpp"

namespace hamgen {
namespace {

// Scenes of larger systems are evaluated only when they are run.
constexpr long largest_checked_scene = 1000;

// Derivatives are taken of formulas as they are when written out, definitions put in: seconds for
// so many operations, and four times as long for twice as many.
constexpr double most_operations = 10'000;

class ModelReader {
 public:
  explicit ModelReader(const SourceText& source)
      : syntax_(parse(source)), diagnostics_(syntax_.diagnostics), symbols_(source, diagnostics_) {
    model_.source = source;
  }

  Model run(const std::map<std::string, long>& sizes) {
    name_system();
    declare_all(syntax_, sizes, model_, symbols_, known_);
    for (const Formula& each : syntax_.definitions) define(each);
    read_hamiltonian();
    for (const Formula& each : syntax_.invariants) {
      check_formula(each.value, formula_role(std::nullopt));
      model_.invariants.push_back({.name = each.name.text,
                                   .value = each.value,
                                   .text = each.text,
                                   .comment = each.comment,
                                   .span = each.name.span});
      check_length(each);
    }
    for (const ModelEvent& each : syntax_.events) {
      check_formula(each.value, formula_role(std::nullopt));
      model_.events.push_back(each);
      check_length(
          {.name = {each.name, each.span}, .value = each.value, .text = {}, .comment = {}});
    }
    read_scenes(!sizes.empty());
    throw_if_wrong();
    if (sizes.empty()) evaluate_scenes();
    throw_if_wrong();
    warn_of_unused();
    return std::move(model_);
  }

 private:
  void throw_if_wrong() {
    if (diagnostics_.empty()) return;
    std::ranges::stable_sort(diagnostics_, {}, [](const Diagnostic& d) { return d.span.begin; });
    diagnostics_.erase(std::unique(diagnostics_.begin(), diagnostics_.end()), diagnostics_.end());
    throw ModelError(diagnostics_, model_.source);
  }

  // Without a `system` line the file's name names the system.
  void name_system() {
    for (std::size_t i = 1; i < syntax_.systems.size(); ++i) {
      symbols_.report(syntax_.systems[i].span, "the system is named twice", "keep one");
    }
    if (!syntax_.systems.empty()) {
      model_.name = syntax_.systems.front().text;
      return;
    }
    for (const char c : std::filesystem::path(model_.source.path).stem().string()) {
      const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
      const bool digit = c >= '0' && c <= '9';
      if (letter || (digit && !model_.name.empty())) {
        model_.name += c;
      } else if (!model_.name.empty()) {
        model_.name += '_';
      }
    }
    model_.name.resize(std::min(model_.name.size(), longest_name));
    if (model_.name.empty()) model_.name = "model";
  }

  std::optional<Rational> check_formula(const NodePtr& node, const Role& role) {
    if (!check_names(node, role, symbols_)) return std::nullopt;
    return check_values(node, known_, symbols_);
  }

  // Reported where it first becomes too long; what uses that is counted as if it were short.
  void check_length(const Formula& formula) {
    const double count = written_out_operations(formula.value, operations_);
    operations_[formula.name.text] = count > most_operations ? 0 : count;
    if (count <= most_operations) return;
    symbols_.report(
        formula.name.span,
        fmt::format("'{}' has {:.6g} operations with its definitions written out, more than {}",
                    formula.name.text, count, most_operations),
        "a definition used twice counts twice, and twice again in every one that uses it so");
  }

  void define(const Formula& formula) {
    if (const auto value = check_formula(formula.value, formula_role(formula.name.span.begin))) {
      known_[formula.name.text] = *value;
    }
    check_length(formula);
    model_.definitions.push_back({.name = formula.name.text,
                                  .value = formula.value,
                                  .text = formula.text,
                                  .span = formula.name.span});
  }

  void read_hamiltonian() {
    const Span file_end{model_.source.text.size(), model_.source.text.size()};
    if (syntax_.hamiltonians.empty()) {
      if (!symbols_.is_spoiled("H")) {
        symbols_.report(file_end, "no Hamiltonian given", "write H = p^2/2 - cos(q)");
      }
      return;
    }
    const Formula& first = syntax_.hamiltonians.front();
    for (std::size_t i = 1; i < syntax_.hamiltonians.size(); ++i) {
      symbols_.report(syntax_.hamiltonians[i].name.span, "H is given twice",
                      fmt::format("line {} gives it first",
                                  position(model_.source, first.name.span.begin).line));
    }
    if (model_.coordinates.empty() && model_.momenta.empty() && syntax_.spoiled.empty()) {
      symbols_.report(first.name.span, "no coordinate given",
                      "declare the variables: coordinate q, and momentum p");
    }
    model_.hamiltonian = first.value;
    model_.hamiltonian_text = first.text;
    check_formula(first.value, formula_role(std::nullopt));
    check_length(first);
    if (!syntax_.times.empty() && names_in(first.value).contains("p_t")) {
      symbols_.report(first.name.span, "H uses 'p_t', the momentum that belongs to time",
                      "leave it out: 'time' adds it to H");
    }
  }

  // With sizes that are not the file's only the scene that is run must fit them.
  void read_scenes(bool other_sizes) {
    std::map<std::string, Span> names;
    for (const SceneStatement& each : syntax_.scenes) {
      const auto [first, is_new] = names.emplace(each.scene.name, each.scene.span);
      if (!is_new) {
        symbols_.report(each.scene.span, fmt::format("scene '{}' is given twice", each.scene.name),
                        fmt::format("line {} gives it first",
                                    position(model_.source, first->second.begin).line));
      }
      const auto before = static_cast<std::ptrdiff_t>(diagnostics_.size());
      model_.scenes.push_back(check_scene(each, known_, symbols_));
      if (!other_sizes) continue;
      model_.scenes.back().mistakes.assign(diagnostics_.begin() + before, diagnostics_.end());
      diagnostics_.erase(diagnostics_.begin() + before, diagnostics_.end());
    }
  }

  void evaluate_scenes() {
    if (degrees_of_freedom(model_) > largest_checked_scene) return;
    const auto collect = [this](const auto& evaluate) {
      try {
        static_cast<void>(evaluate());
      } catch (const ModelError& error) {
        diagnostics_.insert(diagnostics_.end(), error.diagnostics().begin(),
                            error.diagnostics().end());
      }
    };
    for (const Scene& scene : model_.scenes)
      collect([&] { return values_of_scene(model_, scene); });
    if (model_.scenes.empty()) collect([&] { return scene_values(model_, SceneRequest{}); });
  }

  void warn(Span span, std::string message, std::string help) {
    model_.warnings.push_back({Severity::warning, span, std::move(message), std::move(help)});
  }

  // Names that H needs, through definitions.
  std::set<std::string> used_by_hamiltonian() const {
    std::set<std::string> used = names_in(model_.hamiltonian);
    for (auto each = model_.definitions.rbegin(); each != model_.definitions.rend(); ++each) {
      if (used.contains(each->name)) used.merge(names_in(each->value));
    }
    return used;
  }

  void warn_of_unused() {
    const std::set<std::string> used = used_by_hamiltonian();
    for (std::size_t i = 0; i < model_.coordinates.size(); ++i) {
      const Variable& q = model_.coordinates[i];
      const Variable& p = model_.momenta[i];
      if (q.is_time) continue;
      if (!used.contains(q.name)) {
        warn(q.span, fmt::format("'{}' does not appear in H", q.name),
             fmt::format("the degree of freedom is kept: '{}' stays constant", p.name));
      }
      if (!used.contains(p.name)) {
        warn(p.span, fmt::format("'{}' does not appear in H", p.name),
             fmt::format("the degree of freedom is kept: '{}' stays constant", q.name));
      }
    }
    warn_of_unused_names();
    std::ranges::stable_sort(model_.warnings, {}, [](const Diagnostic& d) { return d.span.begin; });
  }

  void warn_of_unused_names() {
    std::set<std::string> used = names_in(model_.hamiltonian);
    const auto use = [&](const NodePtr& node) {
      if (node) used.merge(names_in(node));
    };
    for (const Definition& each : model_.definitions) use(each.value);
    for (const Invariant& each : model_.invariants) use(each.value);
    for (const ModelEvent& each : model_.events) use(each.value);
    for (const Parameter& each : model_.parameters) {
      std::ranges::for_each(each.values, use);
    }
    for (const Variable& each : model_.coordinates) {
      for (const auto& [at, value] : each.beyond) use(value);
    }
    for (const Variable& each : model_.momenta) {
      for (const auto& [at, value] : each.beyond) use(value);
    }
    for (const Scene& scene : model_.scenes) {
      for (const NodePtr& node : {scene.h, scene.steps, scene.every}) use(node);
      for (const Setting& setting : scene.settings) std::ranges::for_each(setting.values, use);
    }
    for (const Parameter& each : model_.parameters) {
      if (used.contains(each.name)) continue;
      warn(each.span, fmt::format("parameter '{}' is never used", each.name), "");
    }
    for (const Definition& each : model_.definitions) {
      if (used.contains(each.name)) continue;
      warn(each.span, fmt::format("definition '{}' is never used", each.name), "");
    }
  }

  Syntax syntax_;
  std::vector<Diagnostic> diagnostics_;
  Symbols symbols_;
  KnownValues known_;
  std::map<std::string, double> operations_;  // of definitions, written out
  Model model_;
};

}  // namespace

Model read_model(const SourceText& source) { return read_model(source, {}); }

Model read_model(const SourceText& source, const std::map<std::string, long>& sizes) {
  Model model = ModelReader(source).run(sizes);
  std::vector<std::string> names;
  for (const Size& size : model.sizes) names.push_back(size.name);
  for (const auto& [name, value] : sizes) {
    if (std::ranges::find(names, name) != names.end()) continue;
    const std::string near = nearest(name, names);
    throw UsageError(fmt::format("unknown size '{}'{}", name,
                                 near.empty() ? "" : fmt::format(": did you mean '{}'?", near)));
  }
  return model;
}

}  // namespace hamgen
