// hamgen generate: the emitted files, printed, written or compared with what is there.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/command_line.hpp"
#include "app/output/difference.hpp"
#include "app/output/json_document.hpp"
#include "app/output/output_name.hpp"
#include "app/output/patience.hpp"
#include "app/output/terminal.hpp"
#include "generator/base/c_family.hpp"
#include "generator/base/diagnostic.hpp"
#include "generator/formats/all_formats.hpp"
#include "runtime/atomic_file.hpp"

namespace hamgen::app {
namespace {

struct GenerateOptions {
  MethodOptions method;
  SceneOptions scene;
  std::string output = "-";  // a directory, a file of code, or standard output
  std::string format;
  std::string name_space;
  std::string support;
  std::string batch;
  std::string math;
  std::string require;
  std::string watch_modified;
  bool tangent = false;
  bool events = false;
  bool check = false;
  bool json = false;
  bool quiet = false;
};

std::string path_in(const std::string& directory, const OutputFile& file) {
  return (std::filesystem::path(directory) / file.path).string();
}

// Is it a file of which the emitted code can be read back?
bool has_code(const std::string& path) {
  const bool in_cpp = path.ends_with(".hpp") || path.ends_with(".plugin.cpp");
  return path.find("hamgen_support") == std::string::npos &&
         (in_cpp || c_family_of_file(path) != nullptr);
}

// What a file that is there computes, whatever else of it has changed.
std::string said_of(const std::string& path, const std::string& text, const SourceText& source,
                    const Request& request) {
  if (!has_code(path)) return {};
  EmittedHeader header{.path = path, .text = text};
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  for (const char* name : kSupportFiles) {
    const std::string beside = (folder / name).string();
    if (std::filesystem::exists(beside)) header.beside[name] = runtime::read_file(beside);
  }
  const ReadBack found = read_emitted(source, request, header);
  if (found.outcome == ReadBack::Outcome::same)
    return fmt::format("note: {}: the code is that of the model, read back; the rest differs\n",
                       path);
  return fmt::format(
      "note: {}:{}: {}{}\n", path, found.line,
      found.outcome == ReadBack::Outcome::different ? "the code is another: " : "not understood: ",
      found.what);
}

// Is it the name of a file of code, rather than of a directory?
bool is_code_file(const std::string& output) {
  constexpr std::string_view kEndings[] = {".hpp", ".hh", ".hxx", ".cpp", ".cc", ".cxx"};
  const auto ends = [&](std::string_view end) { return output.ends_with(end); };
  return !std::filesystem::is_directory(output) &&
         (c_family_of_file(output) != nullptr || std::ranges::any_of(kEndings, ends));
}

// The one file that is needed, under the name that was given, below no directory.
OutputFiles under_one_name(const OutputFiles& files, const std::string& name) {
  const auto needed = std::ranges::count(files, OutputFile::Role::needed, &OutputFile::role);
  if (needed != 1)
    throw UsageError(fmt::format(
        "-o {}: there are {} files\nhelp: say where they go with -o DIRECTORY", name, needed));
  const std::string& path = files.front().path;
  const CFamily* const c = c_family_of_file(path);
  const bool unit = path.ends_with(".cpp");
  const bool header = name.ends_with(".hpp") || name.ends_with(".h") || name.ends_with(".hh") ||
                      name.ends_with(".hxx");
  const CFamily* const named_as = c_family_of_file(name);
  const bool fits = c != nullptr ? named_as == c : unit ? !header && named_as == nullptr : header;
  if (!fits)
    throw UsageError(fmt::format("-o {}: what is written is {}\nhelp: let the name end in {}", name,
                                 c != nullptr ? fmt::format("a header in {}", c->language)
                                 : unit       ? "a translation unit in C++"
                                              : "a header in C++",
                                 c != nullptr ? c->extension
                                 : unit       ? ".cpp"
                                              : ".hpp"));
  return {{name, files.front().text}};
}

int compare(const OutputFiles& files, const std::string& directory, const std::string& output,
            const SourceText& source, const Request& request) {
  const std::string& command = request.command;
  std::string text;
  std::string notes;
  for (const OutputFile& file : files) {
    const std::string path = path_in(directory, file);
    if (!std::filesystem::exists(path)) {
      text += fmt::format("{}: missing\n", path);
      continue;
    }
    const std::string there = runtime::read_file(path);
    if (there == file.text) continue;
    text += difference(path, there, path + " (generated)", file.text);
    notes += said_of(path, there, source, request);
  }
  if (text.empty()) return done;
  print(text);
  print_error(notes);
  print_error(fmt::format("help: to bring {} up to date: {} -o {}\n", output, command, output));
  return numerical_failure;
}

// Says which files there are and which have changed.
int write(const OutputFiles& files, const std::string& directory, const GenerateOptions& options) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  make_directories_above({options.output}, options.quiet || options.json);
  for (const OutputFile& file : files) {
    const std::string path = path_in(directory, file);
    const bool changed = runtime::atomic_write(path, file.text);
    rows.push_back({{"path", path}, {"changed", changed}});
    if (!options.quiet && !options.json)
      print_error(fmt::format("{}{}\n", path, changed ? "" : " (unchanged)"));
  }
  if (options.json) print(json_document(nlohmann::ordered_json{{"files", rows}}));
  return done;
}

// The texts, for a program that asks.
int print_as_json(const OutputFiles& files) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const OutputFile& file : files) rows.push_back({{"path", file.path}, {"text", file.text}});
  print(json_document(nlohmann::ordered_json{{"files", rows}}));
  return done;
}

int print_only_file(const OutputFiles& files) {
  const auto needed = std::ranges::count(files, OutputFile::Role::needed, &OutputFile::role);
  if (needed != 1)
    throw UsageError(
        fmt::format("this format has {} files\nhelp: say where they go with -o DIRECTORY", needed));
  print(files.front().text);
  return done;
}

// The names of the list, as short as they are taken, for the help: the first is the default.
std::string format_names() {
  constexpr std::string_view header = "-header";
  std::string names;
  for (const NamedFormat& format : all_formats()) {
    std::string_view name = format.name;
    if (name.ends_with(header)) name.remove_suffix(header.size());
    names += (names.empty() ? "" : ", ") + std::string(name) + (names.empty() ? " (default)" : "");
  }
  return names;
}

// Empty is the default.
std::string known_format(const std::string& name) {
  std::vector<std::string> names;
  for (const NamedFormat& format : all_formats()) names.emplace_back(format.name);
  if (name.empty()) return name;
  for (const std::string& known : names) {
    if (name == known || name + "-header" == known) return known;
  }
  throw UsageError(fmt::format("--format {}: no such format\nhelp: the formats are {}", name,
                               fmt::join(names, ", ")));
}

int generate_files(const GenerateOptions& options) {
  if (options.check && options.json)
    throw UsageError("--check and --json: what differs is said by a diff\nhelp: drop --json");
  if (options.check && options.output == "-")
    throw UsageError("--check compares with the files of a directory\nhelp: add -o DIRECTORY");
  const SourceText source = read_source(options.method.model);
  Request request = request_of(options.method, options.scene, source);
  request.format = known_format(options.format);
  request.name_space = options.name_space;
  request.support = options.support;
  if (!options.batch.empty())
    request.batch = static_cast<int>(
        std::min(integer_value("--batch " + options.batch, options.batch, 1), 1L << 20));
  request.math = options.math;
  request.require = options.require;
  request.tangent = options.tangent;
  request.events = options.events;
  if (!options.watch_modified.empty()) {
    request.watch_modified = modified_term_count("--watch-modified", options.watch_modified);
    if (request.format == "cpp-plugin")
      throw UsageError(
          "--watch-modified with --format cpp-plugin: a plugin's invariants know no step size\n"
          "help: a cpp-header has them as functions of h; hamgen run --watch-modified watches "
          "them");
  }
  record_origin(options.method, source, request);
  OutputFiles files;
  {
    const Patience patience(say_that_proofs_take_long);
    files = generate(source, request);
  }
  const bool one_file = is_code_file(options.output);
  if (!one_file && options.output != "-") require_directory("-o", options.output);
  if (one_file) files = under_one_name(files, options.output);
  const std::string directory = one_file ? "" : options.output;
  if (options.check) return compare(files, directory, options.output, source, request);
  if (options.output != "-") return write(files, directory, options);
  return options.json ? print_as_json(files) : print_only_file(files);
}

}  // namespace

Command add_generate(CLI::App& app) {
  const auto options = std::make_shared<GenerateOptions>();
  CLI::App* parser = app.add_subcommand("generate", "writes the integrator as C++ source");
  parser
      ->add_option("-o,--output", options->output,
                   "there, or to FILE.hpp, .h, .cpp; default: print a single file")
      ->type_name("DIRECTORY");
  parser->add_option("--format", options->format, format_names())->type_name("NAME");
  parser
      ->add_option("--namespace", options->name_space,
                   "SYSTEM::METHOD of the emitted code, or one NAME for both")
      ->type_name("NAME");
  parser
      ->add_option("--support", options->support,
                   "own (default), or shared: fixed parts in a header beside")
      ->type_name("NAME");
  parser->add_option("--batch", options->batch, "")->type_name("W");
  parser
      ->add_option("--math", options->math,
                   "W trajectories in lanes; own functions (default), or libm's")
      ->type_name("NAME");
  parser
      ->add_option("--require", options->require,
                   "only if proved, as symplectic,symmetric,order:2,emitted-code")
      ->type_name("LIST");
  parser->add_flag("--tangent", options->tangent, "");
  parser
      ->add_option("--watch-modified", options->watch_modified,
                   "emit dZ/dz too; K terms of the modified Hamiltonian")
      ->type_name("K");
  parser->add_flag("--events", options->events, "");
  parser->add_flag("--check", options->check,
                   "find the model's events too; compare with DIRECTORY, 1 and a diff");
  add_method_options(*parser, options->method);
  add_scene_choice(*parser, options->scene);
  parser->add_flag("--json", options->json, "");
  parser->add_flag("--quiet", options->quiet, "the files as JSON; no names of files");
  return {parser, [options] { return generate_files(*options); }};
}

}  // namespace hamgen::app
