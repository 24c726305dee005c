// hamgen-mpi: the same bytes from any number of processes, and after one of them is lost.
#include <gtest/gtest.h>

#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

namespace hamgen::app_test {
namespace {

#ifdef HAMGEN_MPI_EXECUTABLE
// Of a job with so many ranks, each with so many threads.  A job that fails is ended at once: by
// default a second passes before each kill.
int mpi(const Scratch& scratch, int ranks, std::vector<std::string> words,
        const std::string& variable = "HAMGEN_NOTHING=1") {
  const std::vector<std::string> head = {"/usr/bin/env",
                                         "OMPI_ALLOW_RUN_AS_ROOT=1",
                                         "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
                                         "OMPI_MCA_rmaps_base_oversubscribe=1",
                                         "OMPI_MCA_odls_base_sigkill_timeout=0",
                                         "OMPI_MCA_btl_vader_single_copy_mechanism=none",
                                         variable,
                                         HAMGEN_MPIEXEC,
                                         "-n",
                                         std::to_string(ranks),
                                         HAMGEN_MPI_EXECUTABLE};
  words.insert(words.begin(), head.begin(), head.end());
  return status_of(words, scratch.path("err"));
}

std::vector<std::string> words_of(const Scratch& scratch, const std::string& output) {
  return {"ensemble",
          scratch.path("pendulum.ham"),
          "--quiet",
          "--over",
          "q=0:3:10000",
          "--steps",
          "50",
          "--random",
          "p=normal(0,0.1)",
          "-o",
          scratch.path(output)};
}

TEST(EnsembleMpi, HasTheSameBytesFromOneTwoAndFourProcesses) {
  const Scratch scratch;
  scratch.write("pendulum.ham", pendulum);
  ASSERT_EQ(hamgen(words_of(scratch, "whole.csv")).status, 0);
  const std::string whole = read(scratch.path("whole.csv"));
  for (const int ranks : {1, 2, 4}) {
    ASSERT_EQ(mpi(scratch, ranks, words_of(scratch, "x.csv")), 0) << read(scratch.path("err"));
    EXPECT_TRUE(read(scratch.path("x.csv")) == whole) << ranks;
  }
  EXPECT_EQ(scratch.names(),
            (std::vector<std::string>{"err", "pendulum.ham", "whole.csv", "x.csv"}));
}

// Each rank ends within its fourth record, whichever comes to that first ends the job.
TEST(EnsembleMpi, ALostProcessEndsTheJobAndTheNextOneGoesOn) {
  const Scratch scratch;
  scratch.write("pendulum.ham", pendulum);
  ASSERT_EQ(hamgen(words_of(scratch, "whole.csv")).status, 0);
  std::vector<std::string> words = words_of(scratch, "x.csv");
  EXPECT_NE(mpi(scratch, 2, words, "HAMGEN_KILL_POINT=6"), 0);
  EXPECT_FALSE(std::filesystem::exists(scratch.path("x.csv")));
  words.emplace_back("--resume");
  EXPECT_NE(mpi(scratch, 4, words, "HAMGEN_KILL_POINT=3"), 0);
  // By another number of processes, or one without MPI.
  EXPECT_EQ(hamgen(words).status, 0);
  EXPECT_TRUE(read(scratch.path("x.csv")) == read(scratch.path("whole.csv")));
}

TEST(EnsembleMpi, SaysWhatIsWrongOnce) {
  const Scratch scratch;
  scratch.write("pendulum.ham", pendulum);
  std::vector<std::string> words = words_of(scratch, "x.csv");
  words[4] = "qq=0:3:10000";
  EXPECT_EQ(mpi(scratch, 2, words), 2);
  const std::string err = read(scratch.path("err"));
  const std::size_t first = err.find("no such variable");
  EXPECT_NE(first, std::string::npos) << err;
  EXPECT_EQ(err.find("no such variable", first + 1), std::string::npos) << err;
  EXPECT_EQ(mpi(scratch, 2, {"--version"}), 0);
  EXPECT_EQ(mpi(scratch, 2, {"run", scratch.path("pendulum.ham")}), 2);
}
#endif

}  // namespace
}  // namespace hamgen::app_test
