#include "app/output/ensemble_file.hpp"
#include "generator/base/diagnostic.hpp"

namespace hamgen::app {

bool has_hdf5() { return false; }

std::unique_ptr<EnsembleFile> make_ensemble_hdf5(const std::string& /*output*/,
                                                 const EnsembleFileHead& /*head*/) {
  internal_error("there is no HDF5");
}

std::vector<std::string> manifest_lines_of_hdf5(const std::string& /*path*/) { return {}; }

}  // namespace hamgen::app
