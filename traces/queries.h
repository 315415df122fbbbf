/// Queries: what the draws between a begin and an end come to, counted by the machine while it draws.
///
/// As in Vulkan an occlusion query counts samples that pass, and pipeline statistics count what stages take
/// in. Pools hold queries of one type. All queries of a stream start reset, and each is begun once at most.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace quadrille::traces {

struct CommandStream;

enum class QueryType : std::uint8_t { kOcclusion, kPipelineStatistics };

/// Of pipeline statistics, as the bits of Vulkan. [VK1.3 #VkQueryPipelineStatisticFlagBits]
enum PipelineStatistic : std::uint32_t {
  kInputAssemblyVertices = 0x1,
  kInputAssemblyPrimitives = 0x2,
  kVertexShaderInvocations = 0x4,
  kClippingInvocations = 0x20,
  kClippingPrimitives = 0x40,
  kFragmentShaderInvocations = 0x80
};
struct StatisticName {
  PipelineStatistic bit;
  std::string_view name;
};
/// All that can be asked for, in the order of their bits.
inline constexpr std::array<StatisticName, 6> kStatistics{
    {{kInputAssemblyVertices, "input_assembly_vertices"},
     {kInputAssemblyPrimitives, "input_assembly_primitives"},
     {kVertexShaderInvocations, "vertex_shader_invocations"},
     {kClippingInvocations, "clipping_invocations"},
     {kClippingPrimitives, "clipping_primitives"},
     {kFragmentShaderInvocations, "fragment_shader_invocations"}}};
inline constexpr std::uint32_t kAllStatistics = 0xe7;

struct QueryPool {
  std::string name;
  QueryType type = QueryType::kOcclusion;
  std::uint32_t statistics = 0;  ///< of `PipelineStatistic`; of pipeline statistics alone
  std::uint32_t queries = 1;
  friend bool operator==(const QueryPool&, const QueryPool&) = default;
};

struct BeginQuery {
  std::uint32_t pool = 0, query = 0;
  /// Of an occlusion query: it tells how many samples passed, and otherwise only whether one did.
  bool precise = false;
  friend bool operator==(const BeginQuery&, const BeginQuery&) = default;
};
struct EndQuery {
  std::uint32_t pool = 0, query = 0;
  friend bool operator==(const EndQuery&, const EndQuery&) = default;
};

/// Puts a precise occlusion query around every draw of a stream, and one of all pipeline statistics around
/// every pass. Throws `UserError` if the stream has queries of its own.
void query_everything(CommandStream& stream);

}  // namespace quadrille::traces
