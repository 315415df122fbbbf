/// Every policy of every kind on the whole machine: described, told from its neighbours by what it does, and
/// without an effect on the picture.
#include "models/memory/dram/scheduler.h"
#include "pipeline/machine/machine_config.h"
#include "scenes/record/post_pass.h"
#include "scenes/scene.h"
#include "tests/pipeline/machine_specimen.h"
#include "tests/pipeline/plan_run.h"

#include <catch2/catch.hpp>

#include <set>
#include <tuple>

using namespace quadrille;
using namespace quadrille::pipeline;
using namespace quadrille::pipeline::test;

namespace {

struct PolicyChoice {
  std::string path;
  const hw::ParamBase* parameter;
};

/// The parameters that choose between policies.
std::vector<PolicyChoice> choices(const MachineConfig& config) {
  std::vector<PolicyChoice> all;
  for (const auto& [path, group] : config.groups())
    for (const hw::ParamBase* p : group->params())
      if (!p->words().empty() && !p->reason_of(p->words().front()).empty())
        all.push_back({fmt::format("{}.{}", path, p->name()), p});
  return all;
}

/// A machine on which all of them have something to choose: little cache, one channel, short timers.
Settings narrow() {
  return {{"gpu.channels", "1"},
          {"l2.cache_lines", "16"},
          {"l2.cache_ways", "4"},
          {"rop.cache_lines", "4"},
          {"rop.cache_ways", "2"},
          {"depth.cache_lines", "4"},
          {"depth.cache_ways", "2"},
          {"texture.cache_lines", "8"},
          {"texture.cache_ways", "2"},
          {"texture.decode_blocks_per_clk", "1"},
          {"memory.page_idle", "20"},
          {"memory.write_queue", "16"},
          {"l2.write_back_lines", "16"},
          {"memory.refresh", "none"},
          {"vertex_fetch.reuse_entries", "8"},
          {"vertex_fetch.batch_vertices", "6"},
          {"core.simds", "1"},
          {"core.simd_lanes", "4"},
          {"work_distributor.block_tiles", "1"}};
}

/// A mesh whose triangles share vertices, lit and textured, and one triangle over all of that picture.
const traces::CommandStream& frame() {
  static const traces::CommandStream stream = [] {
    scenes::SceneOptions options;
    options.width = 64;
    options.height = 48;
    traces::CommandStream flag = scenes::load_scene("builtin:flag", options);
    scenes::add_post_pass(flag, R"(#version 450
layout(location = 0) in vec2 uv;
layout(set = 0, binding = 0) uniform sampler2D picture;
layout(location = 0) out vec4 color;
void main() { color = texture(picture, uv.yx); })");
    traces::validate(flag);
    return flag;
  }();
  return stream;
}

/// All of a run that a policy may change.
using Outcome = std::tuple<std::int64_t, std::uint64_t, std::map<std::string, std::uint64_t>>;

/// A policy that comes with no machine.
class WritesFirst final : public models::DramScheduler {
 public:
  [[nodiscard]] std::uint32_t pick(const models::DramView& view, std::uint32_t bank) const override {
    const std::uint32_t write = view.writes ? view.queue.oldest(bank, true) : models::DramQueue::kNone;
    if (write != models::DramQueue::kNone || !view.reads) return write;
    return view.queue.oldest(bank, false);
  }
  [[nodiscard]] bool looks_beyond_bank() const override { return false; }
};

constexpr models::DramSchedulerPolicy kWritesFirst{
    "writes_first", "a bank's writes go before its reads",
    [](const models::DramSchedulerSetup& /*setup*/) -> std::unique_ptr<models::DramScheduler> {
      return std::make_unique<WritesFirst>();
    }};

}  // namespace

TEST_CASE("policies: each kind that a machine chooses from is listed, and each policy says what it is for") {
  const MachineConfig config;
  std::string kinds;
  for (const PolicyChoice& choice : choices(config)) {
    kinds += choice.path + " ";
    std::set<std::string_view> names, reasons;
    for (const std::string_view word : choice.parameter->words()) {
      INFO(choice.path << "=" << word);
      CHECK(names.insert(word).second);
      CHECK(reasons.insert(choice.parameter->reason_of(word)).second);
    }
    CHECK(names.size() > 1);
  }
  CHECK(kinds ==
        "vertex_fetch.reuse coarse_raster.order coarse_raster.traversal work_distributor.policy "
        "core.scheduler l2.write_back memory.mapping memory.scheduler memory.write_drain memory.page ");
}

TEST_CASE("policies: each differs from its neighbours in what the machine does, and in no pixel") {
  const MachineConfig config;
  const std::uint64_t expected = functional_digest(frame());
  for (const PolicyChoice& choice : choices(config)) {
    std::map<Outcome, std::string_view> seen;
    for (const std::string_view word : choice.parameter->words()) {
      INFO(choice.path << "=" << word);
      Settings settings = narrow();
      settings.emplace_back(choice.path, word);
      const PlanRun run = run_plan(settings, false, frame());
      REQUIRE(run.failure == "");
      CHECK(run.digest == expected);
      CHECK(run.broken.empty());
      const auto [same, fresh] = seen.emplace(Outcome{run.cycles, run.actions, run.tokens}, word);
      INFO("the same as " << same->second);
      CHECK(fresh);
    }
  }
}

TEST_CASE("policies: a scheduler that is added to the list is a legal value, and draws the same picture") {
  Settings usual_settings = narrow();
  usual_settings.emplace_back("memory.write_drain", "off");
  Settings settings = usual_settings;
  settings.emplace_back("memory.scheduler", "writes_first");
  CHECK(run_plan(settings, false, frame()).failure.find("legal: in_order, first_ready") != std::string::npos);
  models::dram_schedulers().add(kWritesFirst);
  const PlanRun run = run_plan(settings, false, frame()), usual = run_plan(usual_settings, false, frame());
  REQUIRE(run.failure == "");
  CHECK(run.digest == functional_digest(frame()));
  CHECK(run.broken.empty());
  CHECK(run.cycles != usual.cycles);
}
