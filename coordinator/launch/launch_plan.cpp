// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/launch_plan.h"

#include <unistd.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <numeric>
#include <set>

#include "common/base/environment.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/base/host.h"
#include "common/base/refuse.h"
#include "common/base/text/printable.h"
#include "coordinator/launch/host_probe.h"
#include "coordinator/launch/own_folder.h"
#include "coordinator/launch/sweep.h"

namespace treefarm {

namespace {

std::vector<HostLine> read_hostfile(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(Location{file, 0, 0}, "cannot be read", "name a file with a host on each line");
    const std::vector<HostLine> hosts = parse_hostfile(std::string(std::istreambuf_iterator<char>(stream), {}), file);
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

/// Checks the folder for temporary files, without which mpirun fails in words of its own.
void check_temporary_folder() {
    const std::filesystem::path parent = temporary_folder();
    try {
        const OwnFolder folder(parent);
        probe_folder(folder.path());
    } catch (const FileError& error) {
        refuse(parent, std::string("cannot hold Open MPI's temporary files: ") + std::strerror(error.code()),
               "set TMPDIR to a folder that takes files");
    }
}

void check_network(const std::string& network, Starter starter) {
    if (network.starts_with('-')) refuse("--network", "\"" + network + "\" is no network", "write one as 10.0.0.0/24");
    if (starter == Starter::srun && network.find(',') != std::string::npos)
        refuse("--network", "names several networks, of which srun takes one", "write one as 10.0.0.0/24");
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
    check_network(options.network, starter_);
    if (starter_ != Starter::mpirun) return;
    check_mpirun(options.mpirun);
    check_temporary_folder();
}

Starter LaunchPlanner::choose_starter() const {
    if (hosts_) return Starter::mpirun;
    if (is_set("SLURM_JOB_ID") && options_.processes != 1 && (options_.processes > 1 || slurm_tasks() > 1))
        return has_pmix() ? Starter::srun : Starter::mpirun;
    return options_.processes > 1 ? Starter::mpirun : Starter::alone;
}

StartPlan LaunchPlanner::plan(const std::filesystem::path& hostfile) const {
    StartPlan plan;
    plan.starter = starter_;
    plan.mpirun = options_.mpirun;
    plan.program = this_program();
    plan.recovery = !options_.no_recovery;
    plan.network = options_.network;
    plan.no_agent = !is_set("SLURM_JOB_ID") &&
                    (!is_set("PATH") || (!is_program(host_agent()) && !(host_agent() == "ssh" && is_program("rsh"))));
    plan.processes = options_.processes > 0 ? options_.processes : is_set("SLURM_JOB_ID") ? slurm_tasks() : 1;
    plan.one_host = !(is_set("SLURM_JOB_ID") && number_in("SLURM_JOB_NUM_NODES") > 1);
    if (hosts_) use_hosts(hostfile, plan);
    return plan;
}

namespace {

using Unreachable = std::map<std::string, std::string>;

/// Words about hosts that do not answer: "node9 does not answer to ssh: 1 of 2 hosts is left (ssh: ...)".
std::string unreachable_words(const Unreachable& unreachable, std::size_t left, std::size_t all) {
    std::string names, reason;
    for (const auto& [host, why] : unreachable) {
        names += (names.empty() ? "" : ", ") + printable(host);
        if (reason.empty() && !why.empty()) reason = " (" + why + ")";
    }
    return names + (unreachable.size() == 1 ? " does" : " do") + " not answer to " + host_agent() + ": " +
           std::to_string(left) + " of " + std::to_string(all) + (left == 1 ? " hosts is" : " hosts are") + " left" +
           reason;
}

/// Words about more processes than slots: mpirun spreads them evenly.
std::string crowded_words(int processes, int slots, const std::vector<HostLine>& hosts) {
    std::string text = std::to_string(processes) + " processes on " + std::to_string(slots) +
                       (slots == 1 ? " slot that is left: " : " slots that are left: ");
    const int count = static_cast<int>(hosts.size());
    for (int k = 0; k < count; ++k)
        if (const int share = processes / count + (k < processes % count ? 1 : 0); share > 0)
            text += (k > 0 ? ", " : "") + std::to_string(share) + " on " +
                    printable(hosts[static_cast<std::size_t>(k)].host);
    return text;
}

}  // namespace

/// Uses the hosts that answer, without the skipped ones; with them if no other is left.
void LaunchPlanner::use_hosts(const std::filesystem::path& hostfile, StartPlan& plan) const {
    const Unreachable unreachable = unreachable_hosts(hosts_->all());
    std::set<std::string> silent;
    for (const auto& [host, why] : unreachable)
        silent.insert(host);
    const std::vector<HostLine> hosts = hosts_->choose(silent);
    if (!silent.empty()) plan.warnings.push_back(unreachable_words(unreachable, hosts.size(), hosts_->all().size()));
    for (const std::string& host : hosts_->resting())
        plan.warnings.push_back(printable(host) + " lost its workers in two attempts: it is left out of this one");
    if (hosts.empty())
        throw RunError(options_.hostfile +
                       ": no host answers, or all of them lost their workers twice: " + plan.warnings.front());
    plan.hosts = hosts;
    const std::string text = hostfile_text(hosts);
    write_file_atomically(hostfile, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()},
                          Outlives::process);
    plan.hostfile = std::filesystem::absolute(hostfile);  // begins with no "-"
    if (options_.processes == 0) plan.processes = static_cast<int>(hosts.size()) + 1;
    const int slots =
        std::accumulate(hosts.begin(), hosts.end(), 0, [](int sum, const HostLine& line) { return sum + line.slots; });
    plan.oversubscribed = plan.processes > slots;
    if (options_.processes > 0 && plan.oversubscribed && hosts.size() < hosts_->all().size())
        plan.warnings.push_back(crowded_words(plan.processes, slots, hosts));
}

void LaunchPlanner::note_end(const std::vector<LifeWorker>& workers) {
    if (hosts_) hosts_->note_end(workers);
}

}  // namespace treefarm
