#include "app/dispatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <functional>
#include <new>
#include <string_view>

#include "app/command_line.hpp"
#include "app/interrupt.hpp"
#include "app/output/terminal.hpp"
#include "generator/base/diagnostic.hpp"
#include "runtime/tool_error.hpp"

namespace hamgen::app {
namespace {

// CLI11 takes the next word as the value of "--alpha=", be it the model, and an empty word, as from
// an unset variable of the shell, as if the option were not there.
void refuse_empty_values(const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (word.starts_with("--") && word.size() > 3 && word.find('=') == word.size() - 1)
      throw UsageError(fmt::format("{} has no value", word));
    if (!word.empty()) continue;
    throw UsageError(
        fmt::format("an empty word after {}\nhelp: is a variable of the shell not set?",
                    &word == words.data() ? "hamgen" : *(&word - 1)));
  }
}

// "help run" is "run --help", "run --version" is "--version".
std::vector<std::string> as_options(std::vector<std::string> words, const CLI::App& app) {
  if (words.size() == 2 && words[1] == "--version") return {"--version"};
  if (words.empty() || words[0] != "help") return words;
  words.erase(words.begin());
  if (!words.empty() && words[0] == "help") return {"--help"};
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  if (!words.empty() && words[0][0] != '-' && std::ranges::find(names, words[0]) == names.end()) {
    const std::string near = nearest(words[0], names);
    throw UsageError(
        fmt::format("help {}: no such command\nhelp: {}", words[0],
                    near.empty() ? "see hamgen --help" : fmt::format("did you mean '{}'?", near)));
  }
  words.emplace_back("--help");
  return words;
}

std::string_view without_line_end(std::string_view text) {
  return text.substr(0, text.find_last_not_of('\n') + 1);
}

const CLI::App& chosen(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : *parsed.front();
}

// The nearest option or subcommand to a word that was not expected.
std::string suggestion(const CLI::App& command, const std::string& word) {
  std::vector<std::string> candidates;
  for (const CLI::App* subcommand : command.get_subcommands({}))
    if (!subcommand->get_group().empty()) candidates.push_back(subcommand->get_name());
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) candidates.push_back("--" + name);
  }
  return nearest(word.substr(0, word.find('=')), candidates);
}

bool has_option(const CLI::App& command, const std::string& name) {
  return std::ranges::any_of(command.get_options(), [&name](const CLI::Option* option) {
    return option->check_lname(name);
  });
}

// The commands of the help that have the option: "run, bench and others".
std::string commands_with(const CLI::App& app, const std::string& option) {
  constexpr std::size_t shown = 3;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (!command->get_group().empty() && has_option(*command, option))
      names.push_back(command->get_name());
  }
  const bool more = names.size() > shown;
  if (more) names.resize(shown);
  return fmt::format("{}{}", fmt::join(names, ", "), more ? " and others" : "");
}

// What would help where the word was not expected; empty if nothing is known.  An option that other
// commands have is no slip of the pen: it is said whose it is, unless this one has its plural.
std::string help_for(const CLI::App& app, const CLI::App& command, const std::string& word) {
  const std::string near = suggestion(command, word);
  const std::string option = word.substr(0, word.find('='));
  if (option.starts_with("--") && near != option + "s" && near + "s" != option) {
    const std::string others = commands_with(app, option.substr(2));
    if (!others.empty()) {
      const std::string own = command.get_parent() == nullptr ? "" : command.get_name() + " ";
      return fmt::format("help: {} is an option of {}; see hamgen {}--help\n", option, others, own);
    }
  }
  return near.empty() ? "" : fmt::format("help: did you mean '{}'?\n", near);
}

std::string explain(const CLI::ParseError& error, const CLI::App& app,
                    const std::vector<std::string>& words) {
  const CLI::App& command = chosen(app);
  std::string text = fmt::format("hamgen: {}\n", error.what());
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
    text = fmt::format("hamgen: {}: one value is wanted, once\n",
                       text.substr(8, text.find(':', 8) - 8));
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr ||
      (command.get_parent() == nullptr && !words.empty())) {
    const std::vector<std::string> extras = command.remaining();
    const std::string word = extras.empty() ? words.front() : extras.front();
    text = fmt::format("hamgen: unexpected '{}'\n", word);
    const std::string help = help_for(app, command, word);
    if (!help.empty()) return text + help;
  }
  const std::string name = command.get_parent() == nullptr ? "" : command.get_name() + " ";
  return text + fmt::format("help: see hamgen {}--help\n", name);
}

struct NamedCommand {
  std::string_view name;
  std::function<Command(CLI::App&)> add;
};

// In the order of the help.
std::vector<NamedCommand> all_commands(Crew& crew) {
  const auto ensemble = [&crew](CLI::App& app) { return add_ensemble(app, crew); };
  return {{"new", add_new},
          {"check", add_check},
          {"show", add_show},
          {"generate", add_generate},
          {"run", add_run},
          {"bench", add_bench},
          {"report", add_report},
          {"stress", add_stress},
          {"tune", add_tune},
          {"verify", add_verify},
          {"certify", add_certify},
          {"section", add_section},
          {"chaos", add_chaos},
          {"plot", add_plot},
          {"ensemble", ensemble},
          {"list", add_list},
          {"cache", add_cache},
          {"plugin", add_plugin},
          {"completion", add_completion},
          {"man", add_man}};
}

// Those that write about all commands.
constexpr std::array<std::string_view, 2> kWriteAboutAll = {"completion", "man"};

enum class Known { named_command, all_commands };

// Note [the command that is named]
// To know the options of all commands takes a fifth of a short run, and where the command line is
// right none but those of the command that it names are looked at.  What is said of a wrong one,
// and help, need all.
int run_subcommand(const std::vector<std::string>& words, Crew& crew, Known known) {
  CLI::App app("Turns a Hamiltonian, written in a small text file, into a symplectic integrator.",
               "hamgen");
  const std::vector<NamedCommand> all = all_commands(crew);
  const bool names_one = !words.empty() &&
                         std::ranges::find(all, words[0], &NamedCommand::name) != all.end() &&
                         std::ranges::find(kWriteAboutAll, words[0]) == kWriteAboutAll.end();
  const bool only_named = known == Known::named_command && names_one;
  std::vector<Command> commands;
  for (const NamedCommand& command : all) {
    if (!only_named || command.name == words[0]) commands.push_back(command.add(app));
  }
  app.set_version_flag("--version", "hamgen " HAMGEN_VERSION, "the version");
  app.require_subcommand(1);
  app.footer(
      "exit status: 0 done, 1 numerical failure or a difference found, 2 usage, 3 model error,\n"
      "             4 tool failure (compiler, files), 5 proof failed, 6 out of time (--seconds)");
  use_short_help(app);
  try {
    refuse_empty_values(words);
    const std::vector<std::string> asked = as_options(words, app);
    app.parse(
        std::vector<std::string>(asked.rbegin(), asked.rend()));  // it takes them from the end
  } catch (const CLI::CallForVersion& version) {
    print(std::string(version.what()) + "\n");
    return done;
  } catch (const CLI::ParseError& error) {
    if (only_named) return run_subcommand(words, crew, Known::all_commands);
    if (dynamic_cast<const CLI::CallForHelp*>(&error) != nullptr) {
      print(app.help());
      return done;
    }
    print_error(explain(error, app, words));
    return usage_error;
  }
  for (const Command& command : commands) {
    if (command.parser->parsed()) return command.run();
  }
  internal_error("no subcommand was chosen");
}

}  // namespace

namespace {

// Mistakes in the text of an option are no mistakes of the model.
bool are_of_options(const ModelError& error) {
  return std::ranges::all_of(
      error.locations(), [](const Location& location) { return location.file.starts_with("--"); });
}

int usage_failure(const char* what) {
  print_error(fmt::format("hamgen: {}\n", without_line_end(what)));
  return usage_error;
}

}  // namespace

// Every way to fail, and only here, becomes a message and an exit status.
int dispatch(const std::vector<std::string>& words, Crew& crew) {
  report_full_files();
  try {
    return run_subcommand(words, crew, Known::named_command);
  } catch (const ModelError& error) {
    if (are_of_options(error)) return usage_failure(error.what());
    print_error(error.what());
    return model_error;
  } catch (const UsageError& error) {
    return usage_failure(error.what());
  } catch (const ProofError& error) {
    print_error(fmt::format("hamgen: {}\n", without_line_end(error.what())));
    return proof_failed;
  } catch (const runtime::ToolError& error) {
    if (interrupt_flag()) {  // a compilation that was given up
      print_error("hamgen: stopped while compiling; nothing was written\n");
      return interrupted;
    }
    print_error(fmt::format("hamgen: {}\n", without_line_end(error.what())));
    return tool_failure;
  } catch (const std::bad_alloc&) {
    print_error("hamgen: out of memory\n");
    return tool_failure;
  } catch (const std::exception& error) {
    print_error(
        fmt::format("hamgen: internal error: {}\n"
                    "help: this is a fault of hamgen, not of the model; please report it\n",
                    error.what()));
    return tool_failure;
  }
}

}  // namespace hamgen::app
