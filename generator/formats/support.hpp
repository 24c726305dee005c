// The fixed blocks of emitted files, which do not depend on the mathematics: where they stand, and
// how the headers of one program share them.
//
// They are the headers of generator/numerics, letter by letter, in a namespace of their scalar
// below one that is named after the digest of all their texts: so equal blocks are one, whatever
// header they come with, and those of two versions of hamgen never mix.  Each has a guard of its
// own.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "generator/algebra/scalar.hpp"
#include "generator/base/code_writer.hpp"
#include "generator/base/fixed_blocks.hpp"
#include "generator/formats/output_files.hpp"

namespace hamgen {

class Support {
 public:
  // With builtins, |x| is the compiler's own function, where no header is wanted.
  // Those that find events are there for headers with events alone, whose blocks have a namespace
  // of their own for them.  Of a batch, for so many lanes.
  Support(const ScalarType& scalar, bool builtins, bool events, int lanes = 0)
      : scalar_(scalar), builtins_(builtins), events_(events), lanes_(lanes) {}

  // Packs and their functions, of steps that have some of their numbers in lanes.
  [[nodiscard]] static Support of_packs(const ScalarType& scalar_type) {
    Support support(scalar_type, false, false);
    support.packs_ = true;
    return support;
  }

  // Adds the blocks that the C++ text uses, and those that these use.
  void require_for(std::string_view code);

  [[nodiscard]] bool uses_eigen() const;
  // Does what is written of them call std::fabs?  `shared`: but for what stands in shared_file().
  [[nodiscard]] bool uses_cmath(bool shared) const;
  // The blocks in their namespace.
  void write(CodeWriter& out, bool shared) const;
  // The names of the blocks that the code uses, made known to the namespace it stands in.
  void write_names(CodeWriter& out, std::string_view code) const;
  // What tells these texts from all others.
  [[nodiscard]] const std::string& digest() const;

 private:
  [[nodiscard]] std::string name_space() const;
  // What tells it from other scalars.
  [[nodiscard]] std::string space() const;
  [[nodiscard]] std::string text(std::string_view block) const;
  [[nodiscard]] std::span<const FixedBlock> all_blocks() const;

  const ScalarType& scalar_;
  bool builtins_;
  bool events_;
  int lanes_;
  bool packs_ = false;
  std::set<std::string_view> blocks_;
  mutable std::string digest_;  // from when it is first asked for
};

// The text once however many headers have it, and an error where another `kind` of this name is.
void write_once(CodeWriter& out, const std::string& macro, const std::string& digest,
                std::string_view kind, const std::string& text);
// For the names of guards.
[[nodiscard]] std::string capitals(std::string text);

// "hamgen_support.hpp" of double numbers, "hamgen_support_events.hpp" of headers with events.
[[nodiscard]] std::string shared_file_name(const ScalarType& scalar, bool events);
// The name that inline namespaces of a batch have: what is compiled for other registers is other
// code, and does not mix.
inline constexpr const char* kRegisters = "HAMGEN_REGISTERS";
// All blocks that need no library in a header that others include.
[[nodiscard]] OutputFile shared_file(const ScalarType& scalar, bool events);

}  // namespace hamgen
