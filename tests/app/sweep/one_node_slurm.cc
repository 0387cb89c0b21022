#include "tests/app/sweep/one_node_slurm.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <stdexcept>
#include <thread>

#include "tests/support/run_program.h"
#include "tests/support/text_file.h"

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr const char* kController = "/usr/sbin/slurmctld";
constexpr const char* kNode = "/usr/sbin/slurmd";
constexpr const char* kInfo = "/usr/bin/sinfo";
constexpr const char* kList = "/usr/bin/squeue";

// A port that nobody listens on; somebody else may take it before it is used.
int FreePort() {
  const int number = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  const bool is_known = ::bind(number, reinterpret_cast<sockaddr*>(&address), size) == 0 &&
                        ::getsockname(number, reinterpret_cast<sockaddr*>(&address), &size) == 0;
  ::close(number);
  if (!is_known) throw std::runtime_error("no port is free on the loopback address");
  return ntohs(address.sin_port);
}

std::string HostName() {
  std::array<char, 256> name = {};
  ::gethostname(name.data(), name.size() - 1);
  const std::string whole = name.data();
  return whole.substr(0, whole.find('.'));
}

std::string Configuration(const fs::path& folder, int processors, int max_array_size) {
  const std::string host = HostName();
  return fmt::format(
      "ClusterName=loopback\n"
      "SlurmctldHost={0}(127.0.0.1)\n"
      "SlurmUser=root\nSlurmdUser=root\n"
      "AuthType=auth/none\nCredType=cred/none\n"
      "SlurmctldPort={1}\nSlurmdPort={2}\n"
      "StateSaveLocation={3}/state\nSlurmdSpoolDir={3}/spool\n"
      "SlurmctldLogFile={3}/controller.log\nSlurmdLogFile={3}/node.log\n"
      "SlurmctldPidFile={3}/controller.pid\nSlurmdPidFile={3}/node.pid\n"
      "ProctrackType=proctrack/linuxproc\nTaskPlugin=task/none\n"
      "JobAcctGatherType=jobacct_gather/none\nAccountingStorageType=accounting_storage/none\n"
      "SelectType=select/cons_tres\nSelectTypeParameters=CR_CPU\n"
      "SchedulerType=sched/builtin\nSchedulerParameters=batch_sched_delay=0,sched_interval=1\n"
      "MpiDefault=none\nSwitchType=switch/none\nMailProg=/bin/true\n"
      "ReturnToService=2\nKillWait=2\nMaxArraySize={5}\nEnforcePartLimits=ALL\n"
      "NodeName={0} NodeAddr=127.0.0.1 CPUs={4} State=UNKNOWN\n"
      "PartitionName=all Nodes={0} Default=YES MaxTime=INFINITE State=UP\n",
      host, FreePort(), FreePort(), folder.string(), processors, max_array_size);
}

std::string EndOf(const fs::path& log) {
  constexpr std::size_t kShown = 1000;
  if (!fs::exists(log)) return log.string() + " isn't there\n";
  const std::string text = test_support::ReadText(log);
  return text.substr(text.size() - std::min(text.size(), kShown));
}

}  // namespace

std::unique_ptr<OneNodeSlurm> OneNodeSlurm::Start(const fs::path& folder, int processors,
                                                  std::string* why_not, int max_array_size) {
  for (const char* program : {kController, kNode, kInfo, kList}) {
    if (fs::exists(program)) continue;
    *why_not = std::string("no ") + program;
    return nullptr;
  }
  if (::geteuid() != 0) {
    *why_not = "slurmd must be root's";
    return nullptr;
  }
  for (const char* made : {"state", "spool"}) fs::create_directories(folder / made);
  const std::string file = (folder / "slurm.conf").string();
  test_support::WriteText(file, Configuration(folder, processors, max_array_size));
  std::unique_ptr<OneNodeSlurm> slurm(new OneNodeSlurm(folder));
  slurm->controller_ =
      std::make_unique<core::Child>(core::ChildProgram{kController, {"slurmctld", "-D", "-f", file}});
  slurm->node_ = std::make_unique<core::Child>(core::ChildProgram{kNode, {"slurmd", "-D", "-f", file}});
  test_support::RunOptions here;
  here.environment = slurm->Environment();
  std::string state;
  for (const auto deadline = std::chrono::steady_clock::now() + 30s;
       std::chrono::steady_clock::now() < deadline;) {
    const auto info = test_support::RunProgram(kInfo, {"--noheader", "--format=%t"}, here);
    if (info.out.starts_with("idle")) return slurm;
    state = info.out + info.err;
    std::this_thread::sleep_for(100ms);
  }
  *why_not = fmt::format("Slurm's node takes no jobs: {}\n{}\n{}", state, EndOf(folder / "controller.log"),
                         EndOf(folder / "node.log"));
  return nullptr;
}

std::map<std::string, std::string> OneNodeSlurm::Environment() const {
  return {{"SLURM_CONF", (folder_ / "slurm.conf").string()}};
}

std::string OneNodeSlurm::Queue() const {
  test_support::RunOptions here;
  here.environment = Environment();
  return test_support::RunProgram(kList, {"--noheader"}, here).out;
}

}  // namespace elbowroom::tests
