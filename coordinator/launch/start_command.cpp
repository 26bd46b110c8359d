// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/start_command.h"

#include "coordinator/run/sign_of_life.h"

namespace treefarm {

namespace {

using Words = std::vector<std::string>;

void add(Words& words, std::initializer_list<std::string> more) {
    words.insert(words.end(), more);
}

void add_parameter(Words& words, const std::string& name, const std::string& value) {
    add(words, {"--mca", name, value});
}

/// Adds keep-alive options: daemons notice a lost host in 20 s instead of ten minutes.
void add_keepalive(Words& words) {
    add_parameter(words, "oob_tcp_keepalive_time", "10");
    add_parameter(words, "oob_tcp_keepalive_intvl", "3");
    add_parameter(words, "oob_tcp_keepalive_probes", "3");
}

void add_one_host(Words& words, const StartPlan& plan) {
    add(words, {"--oversubscribe"});
    add_parameter(words, "btl", "vader,self");
    add_parameter(words, "oob_tcp_if_include", "lo");
    if (!plan.shared_memory.empty()) add_parameter(words, "btl_vader_backing_directory", plan.shared_memory.string());
}

void add_hosts(Words& words, const StartPlan& plan) {
    if (!plan.hostfile.empty()) add(words, {"--hostfile", plan.hostfile.string()});
    add(words, {"--map-by", "node"});
    if (plan.oversubscribed) add(words, {"--oversubscribe"});
    add_parameter(words, "btl", "tcp,vader,self");
    if (!plan.network.empty()) {
        add_parameter(words, "btl_tcp_if_include", plan.network);
        add_parameter(words, "oob_tcp_if_include", plan.network);
    }
    add_keepalive(words);
}

Words mpirun_words(const StartPlan& plan) {
    Words words = {plan.mpirun, "-n", std::to_string(plan.processes), "--bind-to", "none"};
    if (plan.recovery) add(words, {"--enable-recovery"});
    if (plan.no_agent) add_parameter(words, "plm", "isolated");
    const bool alone = plan.hostfile.empty() && plan.one_host;
    if (alone)
        add_one_host(words, plan);
    else
        add_hosts(words, plan);
    // With more ranks than cores a message would wait for a time slice.
    if (alone || plan.oversubscribed) add_parameter(words, "mpi_yield_when_idle", "1");
    add_parameter(words, "pml", "ob1");
    if (!plan.temporary.empty()) add_parameter(words, "orte_tmpdir_base", plan.temporary.string());
    add(words, {"-x", kAttemptVariable});
    if (!plan.warnings.empty()) add(words, {"-x", kWarningsVariable});
    return words;
}

/// Words of an srun command. -K0: a task that dies ends no other. A worker is one process with a thread for each
/// processor of its node: binding would limit it to one, and rank 0 needs none of its own. Environment variables are
/// exported even under sbatch --export=NONE.
Words srun_words(const StartPlan& plan) {
    Words words = {"srun", "--mpi=pmix", "-n", std::to_string(plan.processes), "--cpu-bind=none", "--overcommit"};
    words.push_back("--export=ALL" + (plan.network.empty() ? "" : ",OMPI_MCA_btl_tcp_if_include=" + plan.network));
    if (plan.recovery) add(words, {"-K0", "--no-kill"});
    return words;
}

}  // namespace

Words start_command(const StartPlan& plan, const Words& words) {
    Words command;
    if (plan.starter == Starter::mpirun) command = mpirun_words(plan);
    if (plan.starter == Starter::srun) command = srun_words(plan);
    command.push_back(plan.program);
    command.insert(command.end(), words.begin(), words.end());
    return command;
}

}  // namespace treefarm
