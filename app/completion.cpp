// hamgen completion, hamgen man: what a shell and a manual reader need, made from the command's own
// definition.  Neither is listed in the help: the installation calls them.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

#include "app/command_line.hpp"
#include "app/output/terminal.hpp"
#include "generator/algebra/scalar.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/formats/all_formats.hpp"
#include "generator/schemes/all_schemes.hpp"
#include "generator/solvers/all_solvers.hpp"
#include "runtime/atomic_file.hpp"

namespace hamgen::app {
namespace {

std::vector<const CLI::App*> listed_commands(const CLI::App& app) {
  std::vector<const CLI::App*> result;
  for (const CLI::App* command : app.get_subcommands({})) {
    if (!command->get_group().empty()) result.push_back(command);
  }
  return result;
}

// "--beta", "-o"
std::vector<std::string> option_words(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) words.push_back("--" + name);
    for (const std::string& name : option->get_snames()) words.push_back("-" + name);
  }
  return words;
}

template <class Rows>
std::vector<std::string> names_of(const Rows& rows) {
  std::vector<std::string> names;
  for (const auto& row : rows) names.emplace_back(row.name);
  return names;
}

// What may follow an option that takes a name from a list.
std::map<std::string, std::vector<std::string>> values_of_options() {
  const std::vector<std::string> schemes = names_of(all_schemes());
  return {{"--scheme", schemes},
          {"--schemes", schemes},
          {"--solver", names_of(all_solvers())},
          {"--format", names_of(all_formats())},
          {"--scalar", {"float", "double", "long-double", "quad"}},
          {"--support", {"own", "shared"}},
          {"--math", {"own", "libm"}},
          {"--gauge", {"locally-exact"}},
          {"--gauge-form", {"scalar", "diagonal", "matrix"}},
          {"--indicator", {"megno", "lyapunov", "fli", "sali"}},
          {"--direction", {"rising", "falling", "both"}},
          {"--stage", {"model", "mechanics", "equations", "plan", "program", "origins"}}};
}

// What may follow a command that takes no file.
std::map<std::string, std::vector<std::string>> words_of_commands() {
  return {{"list", {"functions", "schemes", "solvers", "formats"}},
          {"cache", {"list", "clear", "prune"}}};
}

bool takes_path(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type == "FILE" || type == "DIRECTORY" || type == "DIR";
}

// "-o|--output|--plot": the options of all commands whose value is a path.
std::string options_with_paths(const CLI::App& app) {
  std::set<std::string> names;
  for (const CLI::App* command : listed_commands(app)) {
    for (const CLI::Option* option : command->get_options()) {
      if (!takes_path(*option)) continue;
      for (const std::string& name : option->get_lnames()) names.insert("--" + name);
      for (const std::string& name : option->get_snames()) names.insert("-" + name);
    }
  }
  return fmt::format("{}", fmt::join(names, "|"));
}

std::string bash_script(const CLI::App& app) {
  std::string commands;
  std::string options;
  for (const CLI::App* command : listed_commands(app)) {
    commands += (commands.empty() ? "" : " ") + command->get_name();
    options += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(),
                           fmt::join(option_words(*command), " "));
  }
  std::string values;
  for (const auto& [option, names] : values_of_options())
    values += fmt::format("    {}) words=\"{}\" ;;\n", option, fmt::join(names, " "));
  std::string first;
  for (const auto& [command, names] : words_of_commands())
    first += fmt::format("    {}) words=\"{}\" ;;\n", command, fmt::join(names, " "));
  return fmt::format(R"(# Completion of hamgen for bash, made by `hamgen completion bash`.
_hamgen() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} words=""
  if [ "$COMP_CWORD" -eq 1 ] || [ "$previous" = help ]; then
    COMPREPLY=($(compgen -W "{} help --help --version" -- "$current"))
    return
  fi
  # The shell takes "--scheme=gauss-4" for three words.
  [ "$current" = = ] && current=""
  [ "$previous" = = ] && previous=${{COMP_WORDS[COMP_CWORD-2]}}
  local model='*.ham'
  [ "${{COMP_WORDS[1]}}" = plot ] && model='*.csv'
  case $previous in
{}    {}) model='*' ;;
  esac
  if [ -z "$words" ] && [ "${{current#-}}" != "$current" ]; then
    case ${{COMP_WORDS[1]}} in
{}    esac
  elif [ "$COMP_CWORD" -eq 2 ]; then
    case ${{COMP_WORDS[1]}} in
{}    esac
  fi
  if [ -n "$words" ]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  else
    compopt -o filenames 2>/dev/null  # a folder makes a path of no other word
    COMPREPLY=($(compgen -f -X "!$model" -- "$current") $(compgen -d -S / -- "$current"))
  fi
}}
complete -o nospace -F _hamgen hamgen
)",
                     commands, values, options_with_paths(app), options, first);
}

// In single quotes, and safe for the brackets and colons of _arguments.
std::string zsh_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
      continue;
    }
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

std::string zsh_script(const CLI::App& app) {
  const auto values = values_of_options();
  std::string commands;
  std::string cases;
  for (const CLI::App* command : listed_commands(app)) {
    commands +=
        fmt::format("    '{}:{}'\n", command->get_name(), zsh_text(command->get_description()));
    cases += fmt::format("    {}) _arguments \\\n", command->get_name());
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) {
        const bool takes = option->get_items_expected_max() > 0;
        const auto list = values.find("--" + name);
        const std::string what =
            !takes                 ? ""
            : list != values.end() ? fmt::format(":name:({})", fmt::join(list->second, " "))
            : takes_path(*option)  ? ":file:_files"
                                   : fmt::format(":{}:", zsh_text(option->get_type_name()));
        for (const std::string& letter : option->get_snames())
          cases += fmt::format("      '-{}[{}]{}' \\\n", letter,
                               zsh_text(option->get_description()), what);
        // "--name=[what it is]:value:" takes the value as the next word, too.
        cases += fmt::format("      '--{}{}[{}]{}' \\\n", name, takes ? "=" : "",
                             zsh_text(option->get_description()), what);
      }
    }
    const auto words = words_of_commands();
    const auto own = words.find(command->get_name());
    cases += own == words.end()
                 ? fmt::format("      '*:model:_files -g \"*.{}\"' ;;\n",
                               command->get_name() == "plot" ? "csv" : "ham")
                 : fmt::format("      '1:what:({})' ;;\n", fmt::join(own->second, " "));
  }
  return fmt::format(R"(#compdef hamgen
# Completion of hamgen for zsh, made by `hamgen completion zsh`.
_hamgen() {{
  local -a commands
  commands=(
{}    'help:prints the help of a command'
  )
  local -a options=('--help:what commands there are' '--version:which version this is')
  if (( CURRENT == 2 )) || [[ $words[CURRENT-1] == help ]]; then
    if [[ $PREFIX == -* ]]; then _describe option options; else _describe command commands; fi
    return
  fi
  local command=$words[2]
  shift words
  (( CURRENT-- ))
  case $command in
{}  esac
}}
_hamgen "$@"
)",
                     commands, cases);
}

// A minus sign is no hyphen, and a line does not begin with a request.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if (result.empty() && (c == '.' || c == '\'')) {
      result += std::string("\\&") + c;
    } else {
      result += c;
    }
  }
  return result;
}

std::string manual_of(const CLI::App& command) {
  std::string text = fmt::format(".SS hamgen {}\n{}.\n", roff(command.get_name()),
                                 roff(command.get_description()));
  std::string labels;
  for (const CLI::Option* option : command.get_options()) {
    std::string label = option->get_positional() ? option->get_name() : "";
    for (const std::string& name : option->get_snames()) label += "-" + name + ", ";
    for (const std::string& name : option->get_lnames()) label += "--" + name;
    const bool takes = !option->get_positional() && option->get_items_expected_max() > 0;
    if (takes) label += " " + option->get_type_name();
    // As in the help: one without a description shares that of the next.
    labels += (labels.empty() ? "" : ", ") + label;
    if (option->get_description().empty()) continue;
    text += fmt::format(".TP\n.B {}\n{}\n", roff(labels), roff(option->get_description()));
    labels.clear();
  }
  return text;
}

std::string manual(const CLI::App& app) {
  std::string commands;
  for (const CLI::App* command : listed_commands(app)) commands += manual_of(*command);
  return fmt::format(R"(.TH HAMGEN 1 "" "hamgen {}" "User commands"
.SH NAME
hamgen \- from a Hamiltonian in a text file to a symplectic integrator
.SH SYNOPSIS
.B hamgen
COMMAND [MODEL] [options]
.SH DESCRIPTION
{}
.SH COMMANDS
{}.SH EXIT STATUS
0 done; 1 numerical failure or a difference found; 2 usage; 3 model error; 4 tool failure (compiler,
files); 5 proof failed; 6 out of time (\-\-seconds); 130 interrupted.
.SH ENVIRONMENT
.TP
.B CXX
the compiler of what is run
.TP
.B HAMGEN_CACHE, XDG_CACHE_HOME
where compiled integrators are kept
.TP
.B NO_COLOR
no colour on the terminal
)",
                     HAMGEN_VERSION, roff(app.get_description()), commands);
}

int hand_out(const std::string& text, const std::string& file) {
  if (file.empty()) {
    print(text);
  } else {
    runtime::atomic_write(file, text);
  }
  return done;
}

int complete(const CLI::App& app, const std::string& shell, const std::string& file) {
  if (shell != "bash" && shell != "zsh")
    throw UsageError(fmt::format("completion {}: the shells are bash and zsh", shell));
  return hand_out(shell == "bash" ? bash_script(app) : zsh_script(app), file);
}

}  // namespace

Command add_completion(CLI::App& app) {
  const auto shell = std::make_shared<std::string>();
  const auto file = std::make_shared<std::string>();
  CLI::App* parser = app.add_subcommand("completion", "prints what completes hamgen in a shell");
  parser->group("");
  parser->add_option("SHELL", *shell, "bash or zsh")->required();
  parser->add_option("-o,--output", *file, "write there")->type_name("FILE");
  return {parser, [&app, shell, file] { return complete(app, *shell, *file); }};
}

Command add_man(CLI::App& app) {
  CLI::App* parser = app.add_subcommand("man", "prints the manual page");
  const auto file = std::make_shared<std::string>();
  parser->group("");
  parser->add_option("-o,--output", *file, "write there")->type_name("FILE");
  return {parser, [&app, file] { return hand_out(manual(app), *file); }};
}

}  // namespace hamgen::app
