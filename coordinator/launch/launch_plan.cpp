// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/launch_plan.h"

#include <unistd.h>

#include <fstream>
#include <iterator>
#include <numeric>

#include "common/base/environment.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/host.h"
#include "coordinator/launch/host_probe.h"

namespace treefarm {

namespace {

std::vector<HostLine> read_hostfile(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(Location{file, 0, 0}, "cannot be read", "name a file with a host on each line");
    const std::vector<HostLine> hosts = parse_hostfile(std::string(std::istreambuf_iterator<char>(stream), {}));
    if (hosts.empty()) throw InputError(Location{file, 0, 0}, "names no host", "write one on each line: node1 slots=2");
    return hosts;
}

/// Whether Slurm's srun can start MPI processes.
bool has_pmix() {
    constexpr double kSeconds = 10.0;
    return words_of({"srun", "--mpi=list"}, kSeconds).find("pmix") != std::string::npos;
}

/// Number of tasks requested from Slurm; else one worker per node, and rank 0.
int slurm_tasks() {
    if (const int tasks = number_in("SLURM_NTASKS"); tasks > 0) return tasks;
    const int nodes = number_in("SLURM_JOB_NUM_NODES");
    return nodes > 1 ? nodes + 1 : 1;
}

void check_mpirun(const std::string& mpirun) {
    if (!is_program(mpirun))
        throw InputError(Location{mpirun, 0, 0}, "there is no such program",
                         "install Open MPI (openmpi-bin), name its mpirun with --mpirun, or launch one process: -n 1");
    if (geteuid() == 0 && !(is_set("OMPI_ALLOW_RUN_AS_ROOT") && is_set("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM")))
        throw InputError(Location{mpirun, 0, 0}, "does not run as root unless it is told that this is meant",
                         "be another user; in a container set OMPI_ALLOW_RUN_AS_ROOT=1 and "
                         "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1");
}

std::string this_program() {
    std::error_code error;
    const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe", error);
    if (error) throw RunError("cannot find this program's own file: " + error.message());
    return path.string();
}

}  // namespace

LaunchPlanner::LaunchPlanner(const LaunchOptions& options) : options_(options) {
    if (!options.hostfile.empty()) hosts_.emplace(read_hostfile(options.hostfile), host_name());
    starter_ = choose_starter();
    if (starter_ == Starter::mpirun) check_mpirun(options.mpirun);
}

Starter LaunchPlanner::choose_starter() const {
    if (hosts_) return Starter::mpirun;
    if (is_set("SLURM_JOB_ID") && options_.processes != 1 && (options_.processes > 1 || slurm_tasks() > 1))
        return has_pmix() ? Starter::srun : Starter::mpirun;
    return options_.processes > 1 ? Starter::mpirun : Starter::alone;
}

StartPlan LaunchPlanner::plan(const LaunchPaths& paths) const {
    StartPlan plan;
    plan.starter = starter_;
    plan.mpirun = options_.mpirun;
    plan.program = this_program();
    plan.recovery = !options_.no_recovery;
    plan.network = options_.network;
    plan.temporary = paths.temporary;
    plan.shared_memory = paths.shared_memory;
    plan.processes = options_.processes > 0 ? options_.processes : is_set("SLURM_JOB_ID") ? slurm_tasks() : 1;
    plan.one_host = !(is_set("SLURM_JOB_ID") && number_in("SLURM_JOB_NUM_NODES") > 1);
    if (hosts_) use_hosts(paths, plan);
    return plan;
}

/// Uses the hosts that answer, without the skipped ones; with them if no other is left.
void LaunchPlanner::use_hosts(const LaunchPaths& paths, StartPlan& plan) const {
    const std::vector<HostLine> hosts = hosts_->choose(unreachable_hosts(hosts_->all()));
    if (hosts.empty()) throw RunError(options_.hostfile + ": no host answers, or all of them lost their workers twice");
    plan.hosts = hosts;
    const std::string text = hostfile_text(hosts);
    write_file_atomically(paths.hostfile, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()},
                          Outlives::process);
    plan.hostfile = paths.hostfile;
    if (options_.processes == 0) plan.processes = static_cast<int>(hosts.size()) + 1;
    const int slots =
        std::accumulate(hosts.begin(), hosts.end(), 0, [](int sum, const HostLine& line) { return sum + line.slots; });
    plan.oversubscribed = plan.processes > slots;
}

void LaunchPlanner::note_end(const std::vector<LifeWorker>& workers) {
    if (hosts_) hosts_->note_end(workers);
}

}  // namespace treefarm
