#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

TEST(Generate, PrintsTheHeaderWithItsCommand) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const Result result = hamgen({"generate", model, "--beta=-1/400*h", "--alpha", "1/2"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "#pragma once")) << result.out;
  // The order of the options is fixed and words a shell would change are quoted.
  EXPECT_TRUE(contains(result.out, "hamgen generate " + model + " --alpha 1/2 '--beta=-1/400*h'"))
      << result.out;
  EXPECT_EQ(hamgen({"generate", model, "--beta=-1/400*h", "--alpha", "1/2", "-o", "-"}).out,
            result.out);
}

TEST(Generate, NamesTheModelByItsDigest) {
  const Scratch scratch;
  // The digest is what `sha256sum` prints for these bytes.
  const std::string model =
      scratch.write("free.ham", "system free\ncoordinate q\nmomentum p\nH = p^2/2\n");
  const Result result = hamgen({"generate", model});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(
      contains(result.out,
               "//   sha256    c18574c0ad02dea3bfb9bf674f247212857c4c5c4e146311af7882800dd1e75e\n"))
      << result.out;
}

// Whatever it is computed from: by h and the parameters.
TEST(Generate, SaysWhatEachCoefficientIs) {
  const Result result = hamgen({"generate", HAMGEN_SOURCE_DIR "/hamiltonians/harmonic.ham"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "Real c4 = 0.0;  // h/2/(1 + h^2*w^2/4)\n")) << result.out;
  EXPECT_TRUE(contains(result.out, "Real c8 = 0.0;  // h*w^2/(1 + h^2*w^2/4)\n")) << result.out;
}

TEST(Generate, APluginKnowsNoStepOfAModifiedHamiltonian) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const Result result =
      hamgen({"generate", model, "--format", "cpp-plugin", "--watch-modified", "3"});
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.err, "know no step size")) << result.err;
}

TEST(Generate, WritesAndThenFindsNoDifference) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string directory = scratch.path("made");
  const Result written = hamgen({"generate", model, "-o", directory});
  EXPECT_EQ(written.status, 0) << written.err;
  EXPECT_EQ(written.out, "");
  EXPECT_EQ(written.err, directory + "/pendulum.hpp\n");
  const Result compared = hamgen({"generate", model, "-o", directory, "--check"});
  EXPECT_EQ(compared.status, 0);
  EXPECT_EQ(compared.out + compared.err, "");
}

TEST(Generate, SaysWhichDirectoryItMakes) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", pendulum);
  const std::string file = scratch.path("new/deep/m.hpp");
  const Result made = hamgen({"generate", model, "-o", file});
  EXPECT_EQ(made.err, scratch.path("new") + "/ (a new directory)\n" + file + "\n");
  EXPECT_EQ(hamgen({"generate", model, "-o", file}).err, file + " (unchanged)\n");
}

TEST(Generate, WritesAFileThatIsNamedAsOne) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string file = scratch.path("swing.hpp");
  const Result written = hamgen({"generate", model, "-o", file});
  EXPECT_EQ(written.status, 0) << written.err;
  EXPECT_EQ(written.err, file + "\n");
  EXPECT_EQ(read(file), hamgen({"generate", model}).out);
  EXPECT_EQ(hamgen({"generate", model, "-o", file, "--check"}).status, 0);
  scratch.write("swing.hpp", read(file) + "// more\n");
  const Result differs = hamgen({"generate", model, "-o", file, "--check"});
  EXPECT_EQ(differs.status, 1);
  EXPECT_TRUE(contains(differs.err, " -o " + file + "\n")) << differs.err;
  EXPECT_EQ(
      hamgen({"generate", model, "--format", "cpp-plugin", "-o", scratch.path("p.cpp")}).status, 0);
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"p.cpp", "pendulum.ham", "swing.hpp"}));
  // A folder of such a name stays one.
  std::filesystem::create_directory(scratch.path("folder.h"));
  EXPECT_EQ(hamgen({"generate", model, "-o", scratch.path("folder.h")}).status, 0);
  EXPECT_TRUE(std::filesystem::exists(scratch.path("folder.h/pendulum.hpp")));
}

TEST(Generate, RefusesTheNameOfAnotherKindOfFile) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const auto refused = [&](std::vector<std::string> options, const std::string& help) {
    options.insert(options.begin(), {"generate", model});
    const Result result = hamgen(options);
    EXPECT_EQ(result.status, 2) << options[3];
    EXPECT_TRUE(contains(result.err, help)) << result.err;
  };
  refused({"-o", scratch.path("a.cpp")}, "end in .hpp");
  refused({"-o", scratch.path("a.hpp"), "--format", "cpp-plugin"}, "end in .cpp");
  refused({"-o", scratch.path("a.hpp"), "--format", "c-header"}, "end in .h\n");
  refused({"-o", scratch.path("a.hpp"), "--support", "shared"}, "-o DIRECTORY");
  refused({"-o", scratch.path("a.hpp"), "--format", "cmake-package"}, "-o DIRECTORY");
  EXPECT_EQ(scratch.names(), std::vector<std::string>{"pendulum.ham"});
}

TEST(Generate, PrintsADiffOfAChangedFile) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const std::string directory = scratch.path("made");
  ASSERT_EQ(hamgen({"generate", model, "-o", directory}).status, 0);
  const std::string path = directory + "/pendulum.hpp";
  std::string text = read(path);
  text.replace(text.find("#pragma once"), 12, "#pragma twice");
  static_cast<void>(scratch.write("made/pendulum.hpp", text));
  const Result compared = hamgen({"generate", model, "-o", directory, "--check"});
  EXPECT_EQ(compared.status, 1);
  EXPECT_TRUE(contains(compared.out, "-#pragma twice\n+#pragma once\n")) << compared.out;
  EXPECT_TRUE(contains(compared.err, "hamgen generate")) << compared.err;
  EXPECT_EQ(read(path), text);
}

TEST(Generate, SaysWhichFileIsMissing) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const Result compared = hamgen({"generate", model, "-o", scratch.path("none"), "--check"});
  EXPECT_EQ(compared.status, 1);
  EXPECT_EQ(compared.out, scratch.path("none") + "/pendulum.hpp: missing\n");
}

TEST(Generate, RefusesContradictions) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  EXPECT_EQ(hamgen({"generate", model, "--check"}).status, 2);
  EXPECT_EQ(hamgen({"generate", model, "--set", "eps=1"}).status, 2);
  EXPECT_EQ(hamgen({"generate", model, "--format", "cmake-package"}).status, 2);
  EXPECT_EQ(hamgen({"generate", model, "--format", "fortran"}).status, 2);
  EXPECT_EQ(hamgen({"generate", model, "--scheme", "implicit-midpoint", "--alpha", "1"}).status, 2);
  EXPECT_EQ(hamgen({"generate", model, "--fold", "epz"}).status, 2);
  EXPECT_TRUE(contains(hamgen({"generate", model, "--fold", "eps=1"}).err, "--fold eps burns"));
  for (const std::string name : {"double", "a b", "a::", "x{};y", "1a", "a::std::"})
    EXPECT_EQ(hamgen({"generate", model, "--namespace", name}).status, 2) << name;
}

TEST(Generate, APackageLinksWhatItsScalarNeeds) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  for (const char* scalar : {"double", "quad"}) {
    const std::string directory = scratch.path(scalar);
    const Result result = hamgen(
        {"generate", model, "--format", "cmake-package", "--scalar", scalar, "-o", directory});
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(contains(read(directory + "/CMakeLists.txt"), "INTERFACE quadmath)"),
              std::string(scalar) == "quad");
  }
}

TEST(Generate, RegeneratesForAnotherSize) {
  const Scratch scratch;
  const std::string model = scratch.write("chain.ham", chain);
  const Result result = hamgen({"generate", model, "--set", "N=5"});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "--set N=5")) << result.out;
  EXPECT_EQ(hamgen({"generate", model, "--set", "N=0.5"}).status, 2);
}

TEST(Generate, ShowsControlCharactersOfAPath) {
  const Scratch scratch;
  const std::string path = scratch.write("a\n\u202Eb.ham", pendulum);
  const Result result = hamgen({"generate", path});
  EXPECT_EQ(result.status, 0) << result.err;
  const std::string folder = path.substr(0, path.rfind('/') + 1);
  EXPECT_EQ(lines(result.out).at(3),
            "//   command   hamgen generate $'" + folder + "a\\n<U+202E>b.ham'");
  EXPECT_EQ(lines(result.out).at(4), "//   model     " + folder + "a<U+000A><U+202E>b.ham");
}

TEST(Generate, RefusesAnUnwritableDirectory) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const Result result = hamgen({"generate", model, "-o", "/proc/none"});
  EXPECT_EQ(result.status, 4);
  EXPECT_TRUE(contains(result.err, "/proc/none")) << result.err;
}

TEST(Show, PrintsEveryStage) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  for (const std::string stage : {"model", "mechanics", "equations", "plan", "program"}) {
    const Result result = hamgen({"show", model, "--stage", stage});
    EXPECT_EQ(result.status, 0) << stage << result.err;
    EXPECT_TRUE(result.out.ends_with("\n")) << stage;
  }
  EXPECT_EQ(hamgen({"show", model, "--stage", "plans"}).status, 2);
}

TEST(Check, SaysThatAModelIsFine) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const Result result = hamgen({"check", model});
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out,
            model + ": fine: 1 degree of freedom, 1 parameter, 0 invariants, 1 scene\n");
  EXPECT_EQ(result.err, "");
}

TEST(Check, ShowsAMistakeWhereItIs) {
  const Scratch scratch;
  const std::string model =
      scratch.write("wrong.ham", "coordinate theta\nmomentum p\nH = p^2/2 - cos(thta)\n");
  const Result result = hamgen({"check", model});
  EXPECT_EQ(result.status, 3);
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(contains(result.err, model + ":3:17: error: unknown name 'thta'\n")) << result.err;
}

TEST(List, PrintsTheSameNamesAsTextAndAsJson) {
  for (const std::string what : {"functions", "schemes", "solvers", "formats"}) {
    const Result text = hamgen({"list", what});
    const Result json = hamgen({"list", what, "--json"});
    EXPECT_EQ(text.status, 0);
    const nlohmann::json rows = nlohmann::json::parse(json.out);
    ASSERT_FALSE(rows.empty());
    EXPECT_GE(lines(text.out).size(), rows.size() + 1);
    for (const std::string& line : lines(text.out)) EXPECT_LE(line.size(), 100u) << line;
    for (const auto& row : rows)
      EXPECT_TRUE(contains(text.out, "\n" + row["name"].get<std::string>())) << what;
  }
}

TEST(List, OfSchemesIsThatOfAModel) {
  const auto names = [](const std::vector<std::string>& arguments) {
    std::vector<std::string> result;
    for (const std::string& line : lines(hamgen(arguments).out))
      result.push_back(line.substr(0, line.find(' ')));
    return result;
  };
  const std::string model = std::string(HAMGEN_SOURCE_DIR) + "/hamiltonians/double_pendulum.ham";
  const std::vector<std::string> all = names({"list", "schemes"});
  const std::vector<std::string> of_model = names({"list", "schemes", "--for", model});
  const auto has = [](const std::vector<std::string>& list, const std::string& name) {
    return std::ranges::find(list, name) != list.end();
  };
  for (const char* any : {"gauss-4", "implicit-midpoint", "yoshida-4", "rk4"}) {
    EXPECT_TRUE(has(all, any)) << any;
    EXPECT_TRUE(has(of_model, any)) << any;
  }
  // Its H mixes coordinates and momenta.
  for (const char* separable : {"stormer-verlet", "yoshida-4-verlet", "blanes-moan-rkn-6"}) {
    EXPECT_TRUE(has(all, separable)) << separable;
    EXPECT_FALSE(has(of_model, separable)) << separable;
  }
  EXPECT_TRUE(contains(hamgen({"list", "schemes", "--sources"}).out, "Laskar, Robutel 2001"));
  EXPECT_EQ(hamgen({"list", "functions", "--sources"}).status, 2);
}

}  // namespace
}  // namespace hamgen::app_test
