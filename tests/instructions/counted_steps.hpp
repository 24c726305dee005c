// Instructions of emitted steps, counted by callgrind: the same on every machine, for nothing here
// depends on what the processor is or does besides.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace hamgen::instructions {

// A method of a model, from the start of a scene whose parameters are the model's defaults.
struct CountedStep {
  std::string name;
  std::string model;  // in hamiltonians/
  std::string scene;
  std::string scheme = {};
  int order = 0;
  std::map<std::string, long> sizes = {};
};

// The steps that counts.txt has.
[[nodiscard]] const std::vector<CountedStep>& main_steps();

struct EmittedStep {
  std::string name;
  std::string header;         // without its #pragma once
  std::vector<double> state;  // to begin with
  double h = 0;
};

// Its header, as `hamgen run` compiles it; one of several in a program has its own name.
[[nodiscard]] EmittedStep emitted_step(const CountedStep& step);

// With so many instructions more in each step, or a few beyond.
[[nodiscard]] EmittedStep slower(EmittedStep step, int instructions);

using Counts = std::map<std::string, double>;  // by the names of the steps

// Instructions per step of each, all in one program that is compiled with the flags of `hamgen
// run`, but for the oldest x86-64.  Two run lengths are subtracted; what the library's functions
// take is left out.  Throws std::runtime_error.
[[nodiscard]] Counts count_instructions(const std::vector<EmittedStep>& steps,
                                        const std::string& compiler);

}  // namespace hamgen::instructions
