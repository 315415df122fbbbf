#include "tests/lavapipe/vulkan_queries.h"

#include "models/base/error.h"

namespace quadrille::lavapipe {
namespace {

/// In the order of their bits, in which Vulkan writes the values.
constexpr VkQueryPipelineStatisticFlags kCounted =
    VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_PRIMITIVES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_VERTEX_SHADER_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_CLIPPING_INVOCATIONS_BIT |
    VK_QUERY_PIPELINE_STATISTIC_CLIPPING_PRIMITIVES_BIT |
    VK_QUERY_PIPELINE_STATISTIC_FRAGMENT_SHADER_INVOCATIONS_BIT;
constexpr std::uint32_t kValues = 6;

}  // namespace

PassQueries::PassQueries(const VulkanDevice& device, What what, std::uint32_t passes)
    : device_(device), what_(what), passes_(passes) {
  const DeviceInfo& info = device_.info();
  if (what_ == What::kTimes) {
    QUADRILLE_CHECK(info.timestamp_bits > 0, "{} has no timestamps", info.name);
    times_ = create_pool(VK_QUERY_TYPE_TIMESTAMP, 2 * passes_, 0);
    return;
  }
  QUADRILLE_CHECK(info.pipeline_statistics && info.precise_occlusion, "{} has no statistics", info.name);
  statistics_ = create_pool(VK_QUERY_TYPE_PIPELINE_STATISTICS, passes_, kCounted);
  samples_ = create_pool(VK_QUERY_TYPE_OCCLUSION, passes_, 0);
}

VkQueryPool PassQueries::create_pool(VkQueryType type, std::uint32_t count,
                                     VkQueryPipelineStatisticFlags counted) {
  VkQueryPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
  info.queryType = type;
  info.queryCount = count;
  info.pipelineStatistics = counted;
  VkQueryPool pool = VK_NULL_HANDLE;
  require(vkCreateQueryPool(device_.handle(), &info, nullptr, &pool), "vkCreateQueryPool");
  cleanup_.add([this, pool] { vkDestroyQueryPool(device_.handle(), pool, nullptr); });
  return pool;
}

void PassQueries::reset(VkCommandBuffer commands) const {
  if (what_ == What::kTimes) {
    vkCmdResetQueryPool(commands, times_, 0, 2 * passes_);
    return;
  }
  vkCmdResetQueryPool(commands, statistics_, 0, passes_);
  vkCmdResetQueryPool(commands, samples_, 0, passes_);
}

void PassQueries::begin(VkCommandBuffer commands, std::uint32_t pass) const {
  if (what_ == What::kTimes) {
    // At the end of all that came before, so that the pass is charged with nothing of it.
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, times_, 2 * pass);
    return;
  }
  vkCmdBeginQuery(commands, statistics_, pass, 0);
  vkCmdBeginQuery(commands, samples_, pass, VK_QUERY_CONTROL_PRECISE_BIT);
}

void PassQueries::end(VkCommandBuffer commands, std::uint32_t pass) const {
  if (what_ == What::kTimes) {
    vkCmdWriteTimestamp(commands, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, times_, 2 * pass + 1);
    return;
  }
  vkCmdEndQuery(commands, samples_, pass);
  vkCmdEndQuery(commands, statistics_, pass);
}

std::vector<std::uint64_t> PassQueries::results(VkQueryPool pool, std::uint32_t queries,
                                                std::uint32_t values) const {
  std::vector<std::uint64_t> all(std::size_t{queries} * values);
  require(vkGetQueryPoolResults(device_.handle(), pool, 0, queries, 8 * all.size(), all.data(),
                                VkDeviceSize{8} * values, VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "vkGetQueryPoolResults");
  return all;
}

double PassQueries::time_ns() const {
  const std::vector<std::uint64_t> ticks = results(times_, 2 * passes_, 1);
  const std::uint32_t bits = device_.info().timestamp_bits;
  const std::uint64_t valid = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
  double sum = 0;
  for (std::size_t i = 0; i < ticks.size(); i += 2)
    sum += static_cast<double>((ticks[i + 1] - ticks[i]) & valid);
  return sum * device_.info().timestamp_ns;
}

PassStatistics PassQueries::statistics() const {
  const std::vector<std::uint64_t> counts = results(statistics_, passes_, kValues),
                                   samples = results(samples_, passes_, 1);
  PassStatistics sum;
  for (std::uint32_t pass = 0; pass < passes_; ++pass) {
    const std::uint64_t* of_pass = &counts[std::size_t{pass} * kValues];
    sum.input_vertices += of_pass[0];
    sum.input_primitives += of_pass[1];
    sum.vertex_invocations += of_pass[2];
    sum.clipping_invocations += of_pass[3];
    sum.clipping_primitives += of_pass[4];
    sum.fragment_invocations += of_pass[5];
    sum.samples_passed += samples[pass];
  }
  return sum;
}

}  // namespace quadrille::lavapipe
