#include "generator/emit_files.hpp"

#include <fmt/format.h>

#include <bit>
#include <filesystem>

#include "generator/base/diagnostic.hpp"
#include "generator/emitted_spaces.hpp"
#include "generator/emitted_text.hpp"
#include "generator/formats/all_formats.hpp"
#include "generator/formats/cpp_header.hpp"
#include "generator/program/without_tangent.hpp"

namespace hamgen {

namespace {

std::string stem(const std::string& path) {
  const std::string name = std::filesystem::path(path).stem().string();
  return name.empty() ? "model" : name;
}

int lanes_of(const Request& request, const Program& program) {
  if (request.batch == 0) {
    const bool in_lanes = program.stages && program.stages->packs() > 0;
    if (!request.math.empty() && !in_lanes)
      throw UsageError(
          "--math: is of the elementary functions of a batch, and of stages that are computed at "
          "once\nhelp: add --batch 8, or take --scheme gauss-4");
    return 0;
  }
  constexpr int most = 256;  // beyond, compilers take minutes
  if (!std::has_single_bit(static_cast<unsigned>(request.batch)) || request.batch > most)
    throw UsageError(fmt::format(
        "--batch {}: not 1, 2, 4, ..., {}\nhelp: as many numbers as a register has are fastest: 8 "
        "with AVX-512, 4 with AVX2, 2 elsewhere; twice that may be, too",
        request.batch, most));
  if (request.events)
    throw UsageError(
        "--events with --batch: lanes cross at times of their own, which a batch does not look "
        "for\n"
        "help: drop one of the two");
  return request.batch;
}

// What `write` emits.  A constant the scalar has no number for comes out of H, combined from its
// numbers, unless the request has numbers of its own.
template <typename Write>
auto written(const Model& model, const Request& request, Write write) {
  try {
    return write();
  } catch (const OutOfRange& error) {
    if (request.names_member() || request.watch_modified > 0) throw;
    Diagnostic diagnostic = error.diagnostic();
    diagnostic.span = model.hamiltonian->span;
    throw ModelError({std::move(diagnostic)}, model.source);
  }
}

}  // namespace

EmitOptions emit_options(const SourceText& source, const Stages& stages, const Request& request) {
  const bool is_special = request.scene && is_something_left_out(stages);
  return {.file_name = stem(source.path),
          .command = request.command,
          .model_path = source.path,
          .model_digest = request.model_digest,
          .scalar = request.scalar.text(),
          .spaces = emitted_spaces(stages.equations, request,
                                   is_special ? request.scene->values.name : ""),
          .tangent = request.tangent && !without_tangent(stages.plan),
          .shared_support = request.support->shared,
          .watched_step = request.step,
          .lanes = lanes_of(request, stages.program),
          .library_functions = request.math->of_library};
}

EmitOptions options_with_tangent(const SourceText& source, const Stages& stages,
                                 const Request& request) {
  EmitOptions options = emit_options(source, stages, request);
  if (request.tangent && !options.tangent)
    throw UsageError("--tangent: no linearised step: " + *without_tangent(stages.plan));
  return options;
}

std::string header_text(const Stages& stages, const EmitOptions& options, const Request& request) {
  return written(stages.model, request, [&] { return cpp_header(stages.program, options); });
}

std::string plugin_text(const Stages& stages, const EmitOptions& options, const Request& request) {
  return written(stages.model, request, [&] { return cpp_plugin(stages.program, options); });
}

OutputFiles files_of(const Stages& stages, const EmitOptions& options, const Request& request) {
  const NamedFormat& format = *request.format->format;
  return written(stages.model, request, [&] { return format.files(stages.program, options); });
}

ReadBack read_files(const OutputFiles& files, const Stages& stages, const Request& request) {
  EmittedFile file{.text = files.front().text,
                   .scalar = request.scalar.text(),
                   .beside = {},
                   .watched_step = request.step,
                   .lanes = request.batch};
  for (const OutputFile& other : files) file.beside[other.path] = other.text;
  return read_back(file, stages.program);
}

ReadBack read_file(const std::optional<EmittedHeader>& there, const SourceText& source,
                   const Stages& stages, const Request& request) {
  if (!there)
    return read_files(files_of(stages, emit_options(source, stages, request), request), stages,
                      request);
  const EmittedFile file{.text = there->text,
                         .scalar = request.scalar.text(),
                         .beside = there->beside,
                         .watched_step = request.step,
                         .lanes = request.batch};
  return read_back(file, stages.program);
}

void add_proof(const SourceText& source, const Stages& stages, const Request& request,
               const OutputFiles& files, EmitOptions& options) {
  Proof proof = prove(source, request, stages);
  add_emitted_code(read_files(files, stages, request), "", proof);
  require(proof, *request.require);
  require_emitted(proof);
  options.proved = properties_with(proof, Verdict::proved);
  options.tested = properties_with(proof, Verdict::tested);
  options.refuted = properties_with(proof, Verdict::refuted);
}

}  // namespace hamgen
