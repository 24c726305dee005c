// What can be known before anything takes long is said then; and what is open already is written
// on.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/app/hamgen_command.hpp"

namespace hamgen::app_test {
namespace {

const std::string kModel =
    "coordinate q1, q2\nmomentum p1, p2\nH = (p1^2 + p2^2)/2 + (q1^2 + q2^2)/2 + q1^2*q2 - "
    "q2^3/3\nscene s { q1 = 0.1; p2 = 0.2; h = 0.1; steps = 20 }\n";

// Nothing has been compiled, let alone run, when a file turns out to be no place to write to.
TEST(EarlyRefusal, OfAFileThatCannotBeWritten) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", kModel);
  const std::string no_table = "/dev/null/x.csv";
  const std::string no_picture = "/dev/null/x.png";
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"run", model, "-o", no_table},
           {"run", model, "--plot", no_picture},
           {"stress", model, "--vary", "h=0.1:0.2:2", "-o", no_table},
           {"stress", model, "--vary", "h=0.1:0.2:2", "--plot", no_picture},
           {"chaos", model, "-o", no_table},
           {"chaos", model, "--plot", no_picture},
           {"bench", model, "--csv", no_table},
           {"section", model, "--surface", "q1 = 0", "--axes", "q2,p2", "-o", no_table}}) {
    const std::string cache = scratch.path("cache");
    const Result result = hamgen(words, {"HAMGEN_CACHE=" + cache});
    EXPECT_EQ(result.status, 4) << words[0] << words.back();
    EXPECT_NE(result.err.find("cannot write '/dev/null/x."), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(cache)) << words[0] << " " << words.back();
  }
}

// No run is made for a name that is none of a file.
TEST(EarlyRefusal, OfADirectoryWhereAFileIsWanted) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", kModel);
  const std::string cache = scratch.path("cache");
  for (const std::string& name : {scratch.path(""), scratch.path("new") + "/"}) {
    const Result result = hamgen({"run", model, "-o", name}, {"HAMGEN_CACHE=" + cache});
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.err.find("NAME.csv"), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(cache));
  }
  const Result plot = hamgen({"plot", scratch.path(""), "-o", scratch.path("x.svg")});
  EXPECT_EQ(plot.status, 2);
  EXPECT_NE(plot.err.find("it is a directory"), std::string::npos) << plot.err;
}

// That these are refused, with these words.
void expect_refused(const std::vector<std::pair<std::vector<std::string>, std::string>>& all) {
  for (const auto& [words, said] : all) {
    const Result result = hamgen(words);
    EXPECT_EQ(result.status, 2) << words[0];
    EXPECT_NE(result.err.find(said), std::string::npos) << result.err;
  }
}

// Standard output is no directory, and no file of the name "-" is made of it.
TEST(EarlyRefusal, OfStandardOutputWhereFilesAreWanted) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", kModel);
  expect_refused(
      {{{"plugin", model, "-o", "-"}, "help: -o DIRECTORY/"},
       {{"report", model, "-o", "-"}, "help: -o DIRECTORY/"},
       {{"stress", model, "--vary", "h=0.1:0.2:2", "--csv", "-"}, "on standard output: -o -"}});
  EXPECT_FALSE(std::filesystem::exists("-"));
}

// An option that means nothing there is not passed over, and one that asks for too much not begun.
TEST(EarlyRefusal, OfWhatWouldBePassedOver) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", kModel);
  const std::string none = "but none is named\nhelp: add --scene NAME";
  expect_refused(
      {{{"check", model, "--observe", "energy"}, none},
       {{"show", model, "--observe", "energy"}, none},
       {{"generate", model, "--observe", "energy"}, none},
       {{"verify", model, "--emitted", scratch.path("m.hpp"), "--format", "c-header"},
        "leave out one of them"},
       {{"stress", model, "--vary", "h=0.1:0.2:2", "--csv", "a.json"}, "help: -o a.json"},
       {{"section", model, "--orbits", "1e8"}, "100000 at most"}});
}

// A message has the words of the command.
TEST(EarlyRefusal, NamesTheOptionsThatWereGiven) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", kModel);
  const Result stress = hamgen({"stress", model, "--vary", "alpha=0:1:2", "--scheme", "rk4"});
  EXPECT_EQ(stress.status, 2);
  EXPECT_NE(stress.err.find("--vary alpha"), std::string::npos) << stress.err;
  EXPECT_EQ(stress.err.find("--alpha"), std::string::npos) << stress.err;
  const std::string zero =
      scratch.write("z.ham", "coordinate q\nmomentum p\nH = 0^p + p^2\nscene s { q = 1 }\n");
  const Result power = hamgen({"check", zero});
  EXPECT_EQ(power.status, 3);
  EXPECT_EQ(power.err.find("eval()"), std::string::npos) << power.err;
}

// A mistake is shown in the text that it is in.
TEST(EarlyRefusal, OfAGaugeThatHasNoValue) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", "# quartic\n" + kModel);
  const Result result = hamgen({"generate", model, "--beta", "h/(3-3)"});
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(result.err.find("--beta:1:") != std::string::npos) << result.err;
  EXPECT_NE(result.err.find("h/(3-3)"), std::string::npos) << result.err;
}

// Gnuplot is not asked for a picture of nothing, and no script is left.
TEST(EarlyRefusal, OfATableThatIsNoTrajectory) {
  const Scratch scratch;
  const std::string table = scratch.write("a.csv", "a,b\n1,2\n2,3\n");
  const std::string picture = scratch.path("a.svg");
  const Result result = hamgen({"plot", table, "-o", picture});
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("no trajectory"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("help: one over the other: --columns b:a"), std::string::npos);
  EXPECT_EQ(scratch.names(), (std::vector<std::string>{"a.csv"}));
  EXPECT_EQ(hamgen({"plot", table, "-o", picture, "--columns", "b:a"}).status, 0);
}

// What a command reads is not what it writes.
TEST(EarlyRefusal, OfWritingOverWhatIsRead) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", kModel);
  const std::string starts = scratch.write("starts.csv", "q1,q2\n0.1,0\n");
  const std::string rows = scratch.path("rows.csv");
  ASSERT_EQ(hamgen({"generate", model, "-o", scratch.path("m.hpp"), "--quiet"}).status, 0);
  const std::string header = scratch.path("m.hpp");
  const std::string text = read(header);
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"run", model, "-o", rows, "--checkpoint", rows},
           {"run", model, "-o", rows, "--resume", rows},
           {"run", model, "--checkpoint", model},
           {"ensemble", model, "--from", starts, "-o", starts},
           {"verify", model, "--emitted", header, "--certificate", model},
           {"verify", model, "--emitted", header, "--certificate", header}}) {
    const Result result = hamgen(words);
    EXPECT_EQ(result.status, 2) << words[0] << " " << words.back();
    EXPECT_NE(result.err.find("give it a file of its own"), std::string::npos) << result.err;
  }
  EXPECT_EQ(read(model), kModel);
  EXPECT_EQ(read(starts), "q1,q2\n0.1,0\n");
  EXPECT_EQ(read(header), text);
}

// A number that is in the code follows nobody; it is the scene's where the code is made for that.
TEST(EarlyRefusal, OfAFoldedParameterThatIsVaried) {
  const Scratch scratch;
  const std::string model =
      scratch.write("m.ham",
                    "coordinate q\nmomentum p\nparameter k = 1\nH = p^2/2 + k*q^2/2\n"
                    "scene s { q = 1; k = 3; h = 0.1; steps = 5 }\n");
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"chaos", model, "--over", "k=0:10:3", "-o", scratch.path("x.csv")},
           {"stress", model, "--vary", "k=1:2:2", "-o", scratch.path("x.csv")}}) {
    std::vector<std::string> folded = words;
    folded.insert(folded.end(), {"--fold", "k"});
    const Result result = hamgen(folded);
    EXPECT_EQ(result.status, 2) << words[0];
    EXPECT_NE(result.err.find("is varied"), std::string::npos) << result.err;
  }
  const Result proof = hamgen({"verify", model, "--scene", "s", "--fold", "k"});
  EXPECT_EQ(proof.status, 0) << proof.out << proof.err;
}

// A check leaves nothing behind, not even an empty file.
TEST(EarlyRefusal, LeavesNoFileOfOneThatCouldBeWritten) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", kModel);
  const Result result = hamgen({"chaos", model, "--over", "q2=0:1:2,q2=0:1:2", "-o",
                                scratch.path("x.csv"), "--plot", scratch.path("x.png")});
  EXPECT_EQ(result.status, 2);
  EXPECT_NE(result.err.find("both axes are q2"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(scratch.path("x.csv")));
  EXPECT_FALSE(std::filesystem::exists(scratch.path("x.png")));
}

TEST(StandardOutput, IsWrittenOnWhereItIsAFileThatIsThere) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", kModel);
  const std::string log = scratch.path("log");
  const Result result =
      shell("echo before > '" + log + "'; { hamgen run '" + model +
            "' --quiet --interpret -o /dev/stdout; echo after; } >> '" + log + "'");
  ASSERT_EQ(result.status, 0) << result.err;
  const std::string text = read(log);
  EXPECT_TRUE(text.starts_with("before\n# made by"));
  EXPECT_TRUE(text.ends_with("\nafter\n"));
}

TEST(Messages, SayThatWhatIsComputedWantsAName) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", kModel);
  for (const char* text : {"q1^2", "q1 + q2", "energy, q[1]*2", "sqrt(q1)"}) {
    const Result result = hamgen({"run", model, "--observe", text});
    EXPECT_EQ(result.status, 2) << text;
    EXPECT_NE(result.err.find("gets a name of its own"), std::string::npos) << result.err;
  }
}

TEST(Messages, ProposeWhatHelps) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", kModel);
  for (const char* name : {"h", "steps", "every", "observe"}) {
    const Result result = hamgen({"run", model, "--set", std::string(name) + "=10"});
    EXPECT_EQ(result.status, 2);
    EXPECT_NE(result.err.find(std::string("--") + name + " 10"), std::string::npos) << result.err;
  }
  const Result energy =
      hamgen({"check", scratch.write("e.ham", "coordinate q\nmomentum p\nh = p^2/2 + q^2/2\n")});
  EXPECT_EQ(energy.status, 3);
  EXPECT_NE(energy.err.find("the energy is H ="), std::string::npos) << energy.err;
  // No name that a system cannot have.
  for (const std::string& name : {std::string("_x"), std::string(65, 'x')})
    EXPECT_EQ(hamgen({"new", name}, {}, scratch.path("")).status, 2) << name;
  EXPECT_EQ(hamgen({"new", std::string(64, 'x')}, {}, scratch.path("")).status, 0);
}

// Commands that are printed for a model from standard input read it from there.
TEST(Messages, NameStandardInputAsTheCommandDoes) {
  const Scratch scratch;
  const std::string model = scratch.write("m.ham", kModel);
  const Result result = shell(
      "hamgen bench - --schemes rk4,implicit-midpoint --rounds 1 --h 0.1 "
      "--time 2 --quiet < '" +
      model + "'");
  ASSERT_EQ(result.status, 0) << result.err;
  EXPECT_NE(result.out.find("hamgen run - --"), std::string::npos) << result.out;
  EXPECT_EQ(result.out.find("run stdin"), std::string::npos);
}

}  // namespace
}  // namespace hamgen::app_test
