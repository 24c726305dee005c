// From the values of all stages to files, and back.
#pragma once

#include <optional>
#include <string>

#include "generator/formats/emit_options.hpp"
#include "generator/formats/output_files.hpp"
#include "generator/readback/read_back.hpp"
#include "generator/stages.hpp"

namespace hamgen {

[[nodiscard]] EmitOptions emit_options(const SourceText& source, const Stages& stages,
                                       const Request& request);
// Throws UsageError if there is no tangent map and the request wants one.
[[nodiscard]] EmitOptions options_with_tangent(const SourceText& source, const Stages& stages,
                                               const Request& request);

[[nodiscard]] std::string header_text(const Stages& stages, const EmitOptions& options,
                                      const Request& request);
[[nodiscard]] std::string plugin_text(const Stages& stages, const EmitOptions& options,
                                      const Request& request);
// In the format that the request names.
[[nodiscard]] OutputFiles files_of(const Stages& stages, const EmitOptions& options,
                                   const Request& request);

// The first of the files, and what it includes of the others.
[[nodiscard]] ReadBack read_files(const OutputFiles& files, const Stages& stages,
                                  const Request& request);
// A file that is there, or else the one that is emitted.
[[nodiscard]] ReadBack read_file(const std::optional<EmittedHeader>& there,
                                 const SourceText& source, const Stages& stages,
                                 const Request& request);

// What the first lines of a header say of the step; `files` are what is emitted, but for them.
// Throws ProofError if something required does not hold.
void add_proof(const SourceText& source, const Stages& stages, const Request& request,
               const OutputFiles& files, EmitOptions& options);

}  // namespace hamgen
