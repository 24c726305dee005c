// hamgen-mpi: hamgen ensemble by all processes of an MPI job.
#include <mpi.h>

#include <string>
#include <vector>

#include "app/dispatch.hpp"
#include "app/mpi/mpi_crew.hpp"
#include "app/output/terminal.hpp"

namespace {

// The exit status; the job is still to be ended.
int run(const std::vector<std::string>& words, hamgen::app::MpiCrew& crew) {
  const bool is_known =
      !words.empty() && (words[0] == "ensemble" || words[0] == "--help" || words[0] == "--version");
  if (!is_known) {
    if (crew.leads())
      hamgen::app::print_error(
          "hamgen-mpi: it knows the command ensemble\nhelp: mpirun hamgen-mpi ensemble MODEL ...; "
          "for all else there is hamgen\n");
    return 2;
  }
  return hamgen::app::dispatch(words, crew);
}

}  // namespace

int main(int argc, char** argv) {
  int provided = 0;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided);
  int status = 0;
  {
    hamgen::app::MpiCrew crew;
    if (!crew.leads() && !crew.leader_begins()) {
      MPI_Finalize();
      return 0;
    }
    status = run(std::vector<std::string>(argv + 1, argv + argc), crew);
    if (crew.leads()) crew.leave();
    // The others wait for what will not come.
    if (status != 0 && !crew.is_done()) MPI_Abort(MPI_COMM_WORLD, status);
  }
  MPI_Finalize();
  return status;
}
