// HDF5 files of hamgen ensemble, where the library is there.
#include <gtest/gtest.h>

#include "app/output/ensemble_file.hpp"
#include "tests/app/hamgen_command.hpp"
#include "tests/app/models.hpp"

#if __has_include(<hdf5.h>)
#include <hdf5.h>
#endif

namespace hamgen::app_test {
namespace {

#ifdef H5_VERS_MAJOR
std::vector<double> data_set(const std::string& path, const char* name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  const hid_t space = H5Dget_space(set);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  EXPECT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(file);
  return values;
}

TEST(EnsembleHdf5, HasTheNumbersOfTheCsvFileAndTheSameBytesEachTime) {
  const Scratch scratch;
  const std::string model = scratch.write("pendulum.ham", pendulum);
  const auto run = [&](const std::string& output) {
    const Result result = hamgen({"ensemble", model, "--quiet", "--over", "q=0:3:300", "--steps",
                                  "20", "-o", scratch.path(output)});
    EXPECT_EQ(result.status, 0) << result.err;
  };
  run("x.csv");
  run("x.h5");
  run("y.hdf5");
  EXPECT_EQ(read(scratch.path("x.h5")), read(scratch.path("y.hdf5")));
  const std::vector<double> q = data_set(scratch.path("x.h5"), "q");
  const std::vector<double> status = data_set(scratch.path("x.h5"), "status");
  const std::vector<double> steps = data_set(scratch.path("x.h5"), "steps");
  ASSERT_EQ(q.size(), 300U);
  std::size_t row = 0;
  for (const std::string& line : lines(read(scratch.path("x.csv")))) {
    if (line.empty() || line[0] == '#' || line[0] == 'i') continue;
    // index, q_0, status, steps, t, q, ...
    std::size_t at = 0;
    for (int cell = 0; cell < 5; ++cell) at = line.find(',', at) + 1;
    EXPECT_EQ(q.at(row), std::stod(line.substr(at))) << line;
    EXPECT_EQ(status.at(row), 0);
    EXPECT_EQ(steps.at(row), 20);
    ++row;
  }
  EXPECT_EQ(row, 300U);
  EXPECT_EQ(app::manifest_lines_of(scratch.path("x.h5")),
            app::manifest_lines_of(scratch.path("y.hdf5")));
  const Result again = hamgen({"ensemble", model, "--over", "q=0:3:300", "--steps", "20", "-o",
                               scratch.path("x.h5"), "--resume"});
  EXPECT_TRUE(contains(again.err, "nothing is missing")) << again.err;
  const Result other = hamgen({"ensemble", model, "--over", "q=0:3:301", "--steps", "20", "-o",
                               scratch.path("x.h5"), "--resume"});
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(contains(other.err, "is of another ensemble")) << other.err;
}
#else
TEST(EnsembleHdf5, IsSaidToBeMissing) {
  const Scratch scratch;
  const Result result = hamgen({"ensemble", scratch.write("pendulum.ham", pendulum), "--over",
                                "q=0:3:300", "-o", scratch.path("x.h5")});
  EXPECT_EQ(result.status, 2);
  EXPECT_TRUE(contains(result.err, "libhdf5-dev")) << result.err;
}
#endif

}  // namespace
}  // namespace hamgen::app_test
