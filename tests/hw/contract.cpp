#include "tests/hw/contract.h"

#include "hw/base/dispatcher.h"
#include "hw/base/native_driver.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>

/// SystemC's library asks for this symbol; programs that link the harness have a main of their own.
extern "C" int sc_main(int, char**) { return 0; }

namespace quadrille::hw::contract {

namespace {

std::string read_all(int fd) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t n = 0; (n = read(fd, buffer.data(), buffer.size())) > 0;)
    text.append(buffer.data(), static_cast<std::size_t>(n));
  return text;
}

void write_all(int fd, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = write(fd, text.data() + done, text.size() - done);
    if (n <= 0) return;
    done += static_cast<std::size_t>(n);
  }
}

void add_unit_figures(const Unit& unit, std::map<std::string, std::int64_t>& figures) {
  const std::string path = unit.name();
  figures[path + ".busy"] = unit.busy_cycles();
  figures[path + ".waiting"] = unit.waiting_cycles();
  figures[path + ".starved"] = unit.starved_cycles();
  figures[path + ".blocked"] = unit.blocked_cycles();
  figures[path + ".idle"] = unit.idle_cycles();
  figures[path + ".cycles"] = unit.total_cycles();
  figures[path + ".actions"] = static_cast<std::int64_t>(unit.actions());
  for (const PortBase* port : unit.ports()) figures[path + '.' + port->name() + ".waited"] = port->waited();
  if (unit.stats() == nullptr) return;
  for (const Counter* c : unit.stats()->counters())
    figures[path + '.' + std::string(c->name())] = static_cast<std::int64_t>(c->value());
}

/// The edge after the last action, on the clock of the unit that acted.
Tick default_end(const std::vector<Unit*>& units) {
  Tick end = 0;
  for (const Unit* unit : units) {
    if (unit->last_action() >= 0) end = std::max(end, unit->clock().after(unit->last_action(), 1));
  }
  return end;
}

std::string attribution_failures(const std::vector<Unit*>& units, Tick end) {
  std::string text;
  for (const Unit* unit : units) {
    const std::int64_t sum = unit->busy_cycles() + unit->waiting_cycles() + unit->starved_cycles() +
                             unit->blocked_cycles() + unit->idle_cycles();
    const std::int64_t smallest =
        std::min({unit->busy_cycles(), unit->waiting_cycles(), unit->starved_cycles(), unit->blocked_cycles(),
                  unit->idle_cycles()});
    std::int64_t starved = 0, blocked = 0;
    for (const PortBase* port : unit->ports())
      (port->direction() == PortBase::Direction::kIn ? starved : blocked) += port->waited();
    if (sum != unit->clock().edges_before(end))
      text += fmt::format("{}: the four charges sum to {}, not to its {} cycles\n", unit->name(), sum,
                          unit->clock().edges_before(end));
    if (smallest < 0)
      text += fmt::format("{}: a negative charge: busy {}, waiting {}, starved {}, blocked {}, idle {}\n",
                          unit->name(), unit->busy_cycles(), unit->waiting_cycles(), unit->starved_cycles(),
                          unit->blocked_cycles(), unit->idle_cycles());
    if (starved != unit->starved_cycles() || blocked != unit->blocked_cycles())
      text += fmt::format("{}: its ports' waits do not sum to starved and blocked\n", unit->name());
  }
  return text;
}

/// Builds, runs and closes a machine in this process; the outcome as text for the pipe: digest, end, then one
/// figure a line.
std::string run_here(const Builder& build, const Variation& v) {
  std::unique_ptr<Driver> driver;
  if (v.native) driver = std::make_unique<NativeDriver>("driver");
  else driver = std::make_unique<Dispatcher>("driver", v.window);
  const std::unique_ptr<Specimen> specimen = build(*driver, v);
  if (v.order_seed != 0) driver->shuffle(v.order_seed);
  driver->run({});
  const std::vector<Unit*>& units = driver->units();
  if (!specimen->finished())
    return "failed: did not finish; " + deadlock_report(units, std::max<Tick>(0, driver->last_action()));
  const Tick end = specimen->end() == kNever ? default_end(units) : specimen->end();
  close_accounts(units, end);
  if (const std::string text = attribution_failures(units, end); !text.empty()) return "failed: " + text;
  std::map<std::string, std::int64_t> figures;
  for (const Unit* unit : units) add_unit_figures(*unit, figures);
  for (const FifoBase* link : links_of(units))
    figures[link->path() + ".pushes"] = static_cast<std::int64_t>(link->pushes());
  specimen->add_figures(figures);
  std::string text = fmt::format("{} {}\n", specimen->digest(), end);
  for (const auto& [name, value] : figures) text += fmt::format("{} {}\n", name, value);
  return text;
}

}  // namespace

std::string Variation::text() const {
  return fmt::format("{} driver, host order {}, creation order {}{}", native ? "native" : "dispatcher",
                     order_seed, creation_seed, depth_one ? ", all links one deep" : "");
}

std::string in_child(const std::function<std::string()>& body, unsigned timeout_s) {
  std::array<int, 2> result{}, errors{};
  QUADRILLE_CHECK(pipe(result.data()) == 0 && pipe(errors.data()) == 0, "pipe: {}", std::strerror(errno));
  const pid_t child = fork();
  QUADRILLE_CHECK(child >= 0, "fork: {}", std::strerror(errno));
  if (child == 0) {
    setenv("SYSTEMC_DISABLE_COPYRIGHT_MESSAGE", "1", 1);
    for (const int number : {SIGABRT, SIGSEGV, SIGFPE, SIGILL, SIGBUS, SIGTERM})
      std::signal(number, SIG_DFL);  // the test framework's are the parent's
    alarm(timeout_s);
    dup2(errors[1], STDERR_FILENO);
    for (const int fd : {result[0], errors[0], errors[1]}) close(fd);
    try {
      write_all(result[1], body());
    } catch (const std::exception& e) { write_all(result[1], std::string("failed: ") + e.what()); }
    _exit(0);
  }
  close(result[1]);
  close(errors[1]);
  const std::string text = read_all(result[0]);
  const std::string messages = read_all(errors[0]);
  close(result[0]);
  close(errors[0]);
  int status = 0;
  waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) {
    return WTERMSIG(status) == SIGALRM ? fmt::format("failed: still running after {} s", timeout_s)
                                       : fmt::format("failed: signal {}: {}", WTERMSIG(status), messages);
  }
  return text;
}

Outcome run_forked(const Builder& build, const Variation& variation, unsigned timeout_s) {
  const std::string text = in_child([&] { return run_here(build, variation); }, timeout_s);
  Outcome outcome;
  if (text.starts_with("failed:") || text.empty()) {
    outcome.failure = text.empty() ? "failed: ended without a word" : text;
    return outcome;
  }
  std::istringstream lines(text);
  lines >> outcome.digest >> outcome.end;
  lines >> std::ws;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t space = line.rfind(' ');  // a law's name has spaces of its own
    outcome.figures[line.substr(0, space)] = std::stoll(line.substr(space + 1));
  }
  return outcome;
}

std::vector<std::string> differences(const Outcome& a, const Outcome& b, std::size_t limit) {
  std::vector<std::string> all;
  if (a.digest != b.digest) all.push_back(fmt::format("digest {:016x}, not {:016x}", b.digest, a.digest));
  if (a.end != b.end) all.push_back(fmt::format("ends at {} fs, not at {} fs", b.end, a.end));
  for (const auto& [name, value] : a.figures) {
    const auto it = b.figures.find(name);
    if (it == b.figures.end()) all.push_back(fmt::format("{} is missing", name));
    else if (it->second != value) all.push_back(fmt::format("{} is {}, not {}", name, it->second, value));
  }
  if (b.figures.size() > a.figures.size())
    all.push_back(fmt::format("{} figures, not {}", b.figures.size(), a.figures.size()));
  if (all.size() > limit) all.resize(limit);
  return all;
}

std::vector<std::string> violations(const Builder& build, const Options& options) {
  std::vector<std::string> all;
  const auto run = [&](const Variation& v) {
    Outcome outcome = run_forked(build, v, options.timeout_s);
    if (!outcome.failure.empty()) all.push_back(v.text() + ": " + outcome.failure);
    return outcome;
  };
  const auto hold_to = [&](const Outcome& plain, const Variation& v) {
    const Outcome outcome = run(v);
    if (!plain.failure.empty() || !outcome.failure.empty()) return;
    for (const std::string& d : differences(plain, outcome)) all.push_back(v.text() + ": " + d);
  };
  const Outcome plain = run({});
  hold_to(plain, {.native = true});
  if (options.shuffles > 0) hold_to(plain, {.native = true, .order_seed = 1});
  for (int i = 0; i < options.shuffles; ++i)
    hold_to(plain, {.order_seed = static_cast<std::uint64_t>(i) + 2});
  for (int i = 0; i < options.creations; ++i)
    hold_to(plain, {.creation_seed = static_cast<std::uint64_t>(i) + 1});
  if (!options.depth_one) return all;
  const Outcome narrow = run({.depth_one = true});
  hold_to(narrow, {.native = true, .depth_one = true});
  hold_to(narrow, {.order_seed = 1, .depth_one = true});
  if (options.digest_at_depth_one && plain.failure.empty() && narrow.failure.empty() &&
      plain.digest != narrow.digest) {
    all.push_back(
        fmt::format("all links one deep: digest {:016x}, not {:016x}", narrow.digest, plain.digest));
  }
  return all;
}

}  // namespace quadrille::hw::contract
