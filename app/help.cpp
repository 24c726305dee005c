// Help that fits one screen: one line an option, no blank lines between groups.
#include <fmt/format.h>

#include <algorithm>

#include "app/command_line.hpp"

namespace hamgen::app {
namespace {

struct Row {
  std::string left;
  std::string right;
};

// "-o, --output FILE": short names first.
std::string option_label(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  const std::string value = option.get_items_expected_max() > 0 ? option.get_type_name() : "";
  return fmt::format("{}{}{}", fmt::join(names, ", "), value.empty() ? "" : " ", value);
}

std::string usage_line(const CLI::App& app) {
  std::string line = "usage: hamgen";
  if (app.get_parent() == nullptr) return line + " COMMAND ...\n";
  line += " " + app.get_name();
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) continue;
    line += option->get_required() ? " " + option->get_name() : " [" + option->get_name() + "]";
  }
  return line + " [options]\n";
}

// "runs a model" as "Runs a model."
std::string sentence(std::string text) {
  if (text.empty()) return text;
  if (text.front() >= 'a' && text.front() <= 'z')
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  return text.ends_with('.') ? text : text + ".";
}

class ShortHelp : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string /*name*/,
                        CLI::AppFormatMode /*mode*/) const override {
    std::vector<Row> rows;
    for (const CLI::App* command : app->get_subcommands({}))
      if (!command->get_group().empty())
        rows.push_back({command->get_name(), command->get_description()});
    for (const bool positional : {true, false}) {
      for (const CLI::Option* option : app->get_options()) {
        if (option->get_positional() != positional) continue;
        // That of a command is how one came here.
        if (app->get_parent() != nullptr && option == app->get_help_ptr()) continue;
        const std::string label = positional ? option->get_name() : option_label(*option);
        // An option without a description shares the line of the next.
        const bool joined = !rows.empty() && rows.back().right.empty();
        if (joined) {
          rows.back().left += ", " + label;
          rows.back().right = option->get_description();
        } else {
          rows.push_back({label, option->get_description()});
        }
      }
    }
    std::size_t width = 0;
    for (const Row& row : rows) width = std::max(width, row.left.size());
    std::string text = usage_line(*app) + sentence(app->get_description()) + "\n";
    for (const Row& row : rows) text += fmt::format("  {:<{}}  {}\n", row.left, width, row.right);
    return app->get_footer().empty() ? text : text + app->get_footer() + "\n";
  }
};

}  // namespace

void use_short_help(CLI::App& app) {
  const auto help = std::make_shared<ShortHelp>();
  app.formatter(help);
  app.set_help_flag("-h,--help", "this text; help COMMAND or COMMAND --help: that of a command");
  for (CLI::App* command : app.get_subcommands({})) {
    command->formatter(help);
    command->set_help_flag("-h,--help", "this text");
  }
}

}  // namespace hamgen::app
