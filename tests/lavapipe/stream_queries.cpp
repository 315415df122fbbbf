#include "tests/lavapipe/stream_queries.h"

#include <bit>

#include "models/base/error.h"

namespace quadrille::lavapipe {

StreamQueries::StreamQueries(const VulkanDevice& device, const traces::CommandStream& stream)
    : device_(device), stream_(stream) {
  for (const traces::QueryPool& pool : stream.query_pools) {
    const bool occlusion = pool.type == traces::QueryType::kOcclusion;
    if (!(occlusion ? device.info().precise_occlusion : device.info().pipeline_statistics))
      throw user_error("{} has no queries of the type of pool '{}'", device.info().name, pool.name);
    VkQueryPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO;
    info.queryType = occlusion ? VK_QUERY_TYPE_OCCLUSION : VK_QUERY_TYPE_PIPELINE_STATISTICS;
    info.queryCount = pool.queries;
    info.pipelineStatistics = pool.statistics;
    VkQueryPool made = VK_NULL_HANDLE;
    require(vkCreateQueryPool(device.handle(), &info, nullptr, &made), "vkCreateQueryPool");
    cleanup_.add([this, made] { vkDestroyQueryPool(device_.handle(), made, nullptr); });
    pools_.push_back(made);
  }
}

void StreamQueries::reset(VkCommandBuffer commands) const {
  for (std::size_t i = 0; i < pools_.size(); ++i)
    vkCmdResetQueryPool(commands, pools_[i], 0, stream_.query_pools[i].queries);
}

void StreamQueries::begin(VkCommandBuffer commands, const traces::BeginQuery& c) {
  begun_.push_back(c);
  vkCmdBeginQuery(commands, pools_[c.pool], c.query,
                  c.precise ? VkQueryControlFlags{VK_QUERY_CONTROL_PRECISE_BIT} : VkQueryControlFlags{0});
}

void StreamQueries::end(VkCommandBuffer commands, const traces::EndQuery& c) const {
  vkCmdEndQuery(commands, pools_[c.pool], c.query);
}

std::vector<std::vector<std::uint64_t>> StreamQueries::results() const {
  std::vector<std::vector<std::uint64_t>> all;
  for (const traces::BeginQuery& c : begun_) {
    const int statistics = std::popcount(stream_.query_pools[c.pool].statistics);
    std::vector<std::uint64_t>& values =
        all.emplace_back(statistics == 0 ? std::size_t{1} : static_cast<std::size_t>(statistics));
    require(
        vkGetQueryPoolResults(device_.handle(), pools_[c.pool], c.query, 1, 8 * values.size(), values.data(),
                              8 * values.size(), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "vkGetQueryPoolResults");
  }
  return all;
}

}  // namespace quadrille::lavapipe
