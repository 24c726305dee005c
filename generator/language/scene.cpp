#include "generator/language/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "generator/language/check_names.hpp"
#include "generator/language/check_scene.hpp"
#include "generator/language/constant.hpp"
#include "generator/language/parser.hpp"
#include "generator/language/read_model.hpp"

namespace hamgen {
namespace {

constexpr long most_steps = 1'000'000'000'000'000;

using Values = std::map<std::string, Rational>;

std::string element_name(const std::string& name, std::optional<long> at) {
  return at ? fmt::format("{}[{}]", name, *at) : name;
}

// Looks a name up among the values; `index` is the free index of a setting at the value `i`.
Lookup lookup_in(const Values& values, const std::string& index = {}, long i = 0) {
  return
      [&values, index, i](const Node& node, const NameNode& name, const std::optional<long>& at) {
        if (!at && !index.empty() && name.name == index) return Rational(i);
        const auto place = values.find(element_name(name.name, at));
        if (place != values.end()) return place->second;
        throw ConstantError{{Severity::error, node.span,
                             fmt::format("'{}' has no value here", element_name(name.name, at)),
                             at ? "the subscript is outside the array" : ""}};
      };
}

// Every option of the command line that sets something, with the text it was read from.
struct Override {
  SourceText source;
  Setting setting;
};

bool is_not_finite(std::string text) {
  std::erase_if(text, [](char c) { return c == ' ' || c == '+' || c == '-'; });
  std::ranges::transform(text, text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text == "nan" || text == "inf" || text == "infinity";
}

class SceneReader {
 public:
  SceneReader(const Model& model, const SceneRequest& request)
      : model_(model), request_(request), symbols_(model.source, mistakes_) {
    declare_names(model, symbols_);
    for (const Size& each : model.sizes) known_[each.name] = each.value;
    values_ = numbers_of_sizes(model);
  }

  SceneValues run() { return run(find_scene()); }

  // Without a scene and without options.
  std::vector<Rational> default_parameters() {
    std::vector<Rational> result;
    for (const Parameter& each : model_.parameters) read_parameter(each, result);
    stop_if_wrong();
    return result;
  }

  SceneValues run(const Scene* scene) {
    scene_ = scene;
    if (scene_ != nullptr && !scene_->mistakes.empty()) {
      throw ModelError(scene_->mistakes, model_.source);
    }
    for (const auto& [name, value] : request_.set) add_override("--set", name, value);
    for (const auto& [name, value] : request_.initial) add_override("--initial", name, value);
    for (const auto& [name, value] : request_.reference) add_override("--reference", name, value);
    SceneValues result;
    if (scene_ != nullptr) result.name = scene_->name;
    read_observed(result);
    for (const Parameter& each : model_.parameters) read_parameter(each, result.parameters);
    stop_if_wrong();  // values that need a parameter without a value would only repeat the mistake
    for (const Variable& each : model_.coordinates) read_variable(each, result.q);
    for (const Variable& each : model_.momenta) read_variable(each, result.p);
    read_run(result);
    stop_if_wrong();
    return result;
  }

 private:
  void stop_if_wrong() const {
    if (!mistakes_.empty()) throw ModelError(mistakes_, model_.source);
  }

  const Scene* find_scene() const {
    if (request_.scene.empty()) return model_.scenes.empty() ? nullptr : &model_.scenes.front();
    const auto found = std::ranges::find(model_.scenes, request_.scene, &Scene::name);
    if (found != model_.scenes.end()) return &*found;
    std::vector<std::string> names;
    for (const Scene& each : model_.scenes) names.push_back(each.name);
    const std::string near = nearest(request_.scene, names);
    std::string help = fmt::format("it has {}", fmt::join(names, ", "));
    if (names.empty()) help = "it has none";
    if (!near.empty()) help = fmt::format("did you mean '{}'?", near);
    throw UsageError(fmt::format("{} has no scene '{}': {}", model_.name, request_.scene, help));
  }

  // The scene's list, or that of the command line, element by element.
  void read_observed(SceneValues& result) {
    std::vector<Observed> list;
    if (scene_ != nullptr) list = scene_->observe;
    if (request_.observe) {
      const SourceText source = make_source("--observe", *request_.observe);
      try {
        list = parse_observed(source);
      } catch (const ModelError& error) {
        throw OptionError(error);
      }
      check_observed(list, known_, symbols_);
      if (!mistakes_.empty()) throw OptionError(ModelError(mistakes_, source));
    }
    for (const Observed& each : list) {
      const Symbol* symbol = symbols_.find(each.name);
      if (each.value) result.formulas.push_back({each.name, each.value, each.text});
      if (each.element) {
        const Rational at = value_of(each.element, lookup_in(known_), nullptr);
        result.observe.push_back(element_name(each.name, at.get_num().get_si()));
      } else if (symbol != nullptr && symbol->range) {
        for (long i = symbol->range->first; i <= symbol->range->last; ++i)
          result.observe.push_back(element_name(each.name, i));
      } else {
        result.observe.push_back(each.name);
      }
    }
  }

  void add_override(const std::string& option, const std::string& name, const std::string& value) {
    if (is_not_finite(value)) {
      throw UsageError(fmt::format("{} {}={}: not a finite number", option, name, value));
    }
    if (option == "--set" && values_.contains(name) &&
        symbols_.find(name)->kind == SymbolKind::size) {
      return;  // sizes are set when the model is read
    }
    SourceText source = make_source(option, name + "=" + value);
    Setting setting;
    try {
      setting = parse_setting(source);
    } catch (const ModelError& error) {
      throw OptionError(error);
    }
    const Symbol* symbol = symbols_.find(setting.name);
    constexpr std::array<std::string_view, 4> of_runs = {"h", "steps", "every", "observe"};
    if (symbol == nullptr && std::ranges::find(of_runs, setting.name) != of_runs.end()) {
      throw UsageError(
          fmt::format("{0} {1}={2}: {1} is no variable\nhelp: `hamgen run` takes --{1} {2}", option,
                      name, value));
    }
    const bool is_parameter = symbol != nullptr && symbol->kind == SymbolKind::parameter;
    const bool takes_both = option == "--reference";
    if (symbol != nullptr && !takes_both && is_parameter != (option == "--set")) {
      throw UsageError(fmt::format("{} {}={}: '{}' is {}; set it with {}", option, name, value,
                                   setting.name, description(symbol->kind),
                                   is_parameter ? "--set" : "--initial"));
    }
    check_setting(setting, known_, symbols_);
    if (!mistakes_.empty()) throw OptionError(ModelError(mistakes_, source));
    overrides_.push_back({std::move(source), std::move(setting)});
  }

  // Evaluates a constant; a mistake in a scene is collected, one in an option thrown at once.
  Rational value_of(const NodePtr& node, const Lookup& lookup, const SourceText* option) {
    try {
      return evaluate(node, lookup);
    } catch (const ConstantError& error) {
      if (option != nullptr) throw OptionError(ModelError({error.diagnostic}, *option));
      mistakes_.push_back(error.diagnostic);
      return 0;
    }
  }

  void apply(const Setting& setting, const std::optional<IndexRange>& range,
             std::vector<Rational>& elements, const SourceText* option) {
    const long first = range ? range->first : 1;
    const auto value = [&](const NodePtr& node, long i) {
      return value_of(node, lookup_in(values_, setting.index, i), option);
    };
    if (setting.element) {
      const Rational at = value_of(setting.element, lookup_in(known_), option);
      elements.at(static_cast<std::size_t>(at.get_num().get_si() - first)) =
          value(setting.values.front(), 0);
      return;
    }
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const std::size_t mistakes = mistakes_.size();
      elements[i] = value(setting.values[setting.is_list ? i : 0], first + static_cast<long>(i));
      if (mistakes_.size() > mistakes && !setting.is_list) return;
    }
  }

  // The scene's settings of the name, then those of the command line: later ones win.
  void apply_all(const std::string& name, const std::optional<IndexRange>& range,
                 std::vector<Rational>& elements) {
    if (scene_ != nullptr) {
      for (const Setting& each : scene_->settings) {
        if (each.name == name) apply(each, range, elements, nullptr);
      }
    }
    for (const Override& each : overrides_) {
      if (each.setting.name == name) apply(each.setting, range, elements, &each.source);
    }
  }

  void read_parameter(const Parameter& parameter, std::vector<Rational>& result) {
    std::vector<Rational> elements;
    for (const NodePtr& node : parameter.values) {
      elements.push_back(value_of(node, lookup_in(values_), nullptr));
    }
    apply_all(parameter.name, parameter.range, elements);
    for (std::size_t i = 0; i < elements.size(); ++i) {
      std::optional<long> at;
      if (parameter.range) at = parameter.range->first + static_cast<long>(i);
      values_[element_name(parameter.name, at)] = elements[i];
      result.push_back(elements[i]);
    }
  }

  void read_variable(const Variable& variable, std::vector<Rational>& result) {
    std::vector<Rational> elements(variable.range ? static_cast<std::size_t>(variable.range->size())
                                                  : 1);
    apply_all(variable.name, variable.range, elements);
    result.insert(result.end(), elements.begin(), elements.end());
  }

  // A number of the run, from the option or else from the scene.  `wrong` says what is not allowed.
  template <typename Wrong>
  std::optional<Rational> run_value(const std::string& name, const std::optional<std::string>& text,
                                    const NodePtr& node, Wrong wrong) {
    if (text) {
      const std::string option = "--" + name;
      if (is_not_finite(*text)) {
        throw UsageError(fmt::format("{} {}: not a finite number", option, *text));
      }
      std::vector<std::string> names;
      for (const auto& [known, value] : values_) names.push_back(known);
      Rational value;
      try {
        const NodePtr read = read_expression(option, *text, names);
        const SourceText source = make_source(option, *text);
        value = value_of(read, lookup_in(values_), &source);
      } catch (const ModelError& error) {
        throw OptionError(error);
      }
      if (const std::string message = wrong(value); !message.empty()) {
        throw UsageError(fmt::format("{} {}: {}", option, *text, message));
      }
      return value;
    }
    if (!node) return std::nullopt;
    const std::size_t mistakes = mistakes_.size();
    const Rational value = value_of(node, lookup_in(values_), nullptr);
    if (mistakes_.size() > mistakes) return std::nullopt;
    if (const std::string message = wrong(value); !message.empty()) {
      mistakes_.push_back({Severity::error, node->span, message, {}});
    }
    return value;
  }

  void read_run(SceneValues& result) {
    const auto count = [](std::string_view what, long least) {
      return [what, least](const Rational& value) -> std::string {
        if (value.get_den() == 1 && value >= least && value <= most_steps) return {};
        return fmt::format("{} must be an integer between {} and 1e15, not {}", what, least,
                           short_text(value));
      };
    };
    const auto step_size = [](const Rational& value) -> std::string {
      return sgn(value) == 0 ? "the step size h must not be 0" : "";
    };
    const Scene none;
    const Scene& scene = scene_ != nullptr ? *scene_ : none;
    result.h = run_value("h", request_.h, scene.h, step_size);
    const auto steps = request_.time ? steps_of_time(result)
                                     : run_value("steps", request_.steps, scene.steps,
                                                 count("the number of steps", 0));
    const auto every = run_value("every", {}, scene.every, count("the recording interval", 1));
    if (!mistakes_.empty()) return;
    if (steps) result.steps = steps->get_num().get_si();
    if (every) result.every = every->get_num().get_si();
  }

  // As many steps as the time has room for: the last one ends at it, or before.
  std::optional<Rational> steps_of_time(const SceneValues& values) {
    if (request_.steps)
      throw UsageError(fmt::format("--time {} and --steps {} both say how long\nhelp: drop one",
                                   *request_.time, *request_.steps));
    const auto any = [](const Rational&) -> std::string { return {}; };
    const Rational time = run_value("time", request_.time, nullptr, any).value();
    if (!values.h) return std::nullopt;
    const Rational ratio = time / *values.h;
    if (sgn(ratio) < 0)
      throw UsageError(fmt::format("--time {} and h = {} go in opposite directions", *request_.time,
                                   short_text(*values.h)));
    if (sgn(ratio) > 0 && ratio < 1)
      throw UsageError(fmt::format("--time {}: less than a step of h = {}\nhelp: a smaller --h",
                                   *request_.time, short_text(*values.h)));
    if (ratio > most_steps)
      throw UsageError(fmt::format("--time {}: more than 1e15 steps of h = {}", *request_.time,
                                   short_text(*values.h)));
    return Rational(Integer(ratio.get_num() / ratio.get_den()));
  }

  const Model& model_;
  const SceneRequest& request_;
  std::vector<Diagnostic> mistakes_;
  Symbols symbols_;
  Values values_;  // of sizes, and of the parameters so far
  KnownValues known_;
  const Scene* scene_ = nullptr;
  std::vector<Override> overrides_;
};

}  // namespace

SceneValues scene_values(const Model& model, const SceneRequest& request) {
  return SceneReader(model, request).run();
}

SceneValues values_of_scene(const Model& model, const Scene& scene) {
  const SceneRequest request{.scene = scene.name};
  return SceneReader(model, request).run(&scene);
}

std::map<std::string, Rational> numbers_of_sizes(const Model& model) {
  std::map<std::string, Rational> numbers;
  for (const Size& size : model.sizes) numbers[size.name] = size.number;
  return numbers;
}

std::vector<Rational> default_parameters(const Model& model) {
  return SceneReader(model, {}).default_parameters();
}

bool observes(const SceneValues& scene, const std::string& name) {
  return scene.observe.empty() || std::ranges::find(scene.observe, name) != scene.observe.end();
}

bool observes_parts(const Model& model, const SceneValues& scene) {
  if (!scene.formulas.empty()) return true;
  return std::ranges::any_of(scene.observe, [&model](const std::string& name) {
    const std::string base = name.substr(0, name.find('['));
    return std::ranges::find(model.coordinates, base, &Variable::name) != model.coordinates.end() ||
           std::ranges::find(model.momenta, base, &Variable::name) != model.momenta.end();
  });
}

Rational evaluate_constant(const NodePtr& node, const SourceText& source,
                           const std::map<std::string, Rational>& values) {
  try {
    return evaluate(node, lookup_in(values));
  } catch (const ConstantError& error) {
    throw ModelError({error.diagnostic}, source);
  }
}

}  // namespace hamgen
