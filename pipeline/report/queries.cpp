#include "pipeline/report/queries.h"

#include <numeric>

namespace quadrille::pipeline {

namespace {

DrawCount counted_as(traces::PipelineStatistic statistic) {
  switch (statistic) {
    case traces::kInputAssemblyVertices: return DrawCount::kIndices;
    case traces::kInputAssemblyPrimitives: return DrawCount::kTrianglesFetched;
    case traces::kVertexShaderInvocations: return DrawCount::kVerticesShaded;
    case traces::kClippingInvocations: return DrawCount::kTrianglesClipped;
    case traces::kClippingPrimitives: return DrawCount::kPiecesClipped;
    case traces::kFragmentShaderInvocations: return DrawCount::kShaded;
  }
  return DrawCount::kShaded;
}

QueryFigures occlusion(const QueryRange& range, std::uint64_t samples) {
  if (range.precise) return {range, {{"samples_passed", samples}}};
  return {range, {{"any_samples_passed", samples > 0 ? 1 : 0}}};
}

}  // namespace

std::vector<QueryFigures> query_figures(const std::vector<QueryRange>& ranges, const hw::Frame& frame,
                                        const Detail& detail) {
  std::vector<QueryFigures> all;
  all.reserve(ranges.size());
  for (const QueryRange& range : ranges) {
    const auto draws = std::span(detail.draws).subspan(range.first_draw, range.draws);
    const auto sum = [&](DrawCount count) {
      std::uint64_t total = 0;
      for (const DrawFigures& draw : draws) total += draw.of(count);
      return total;
    };
    if (range.type == traces::QueryType::kOcclusion) {
      std::uint64_t samples = sum(DrawCount::kSamplesWritten);
      for (std::uint32_t i = 0; i < range.draws; ++i)
        if (frame.draws[range.first_draw + i].counts_before_shading())
          samples += draws[i].of(DrawCount::kSamplesDiscarded);
      all.push_back(occlusion(range, samples));
      continue;
    }
    QueryFigures& figures = all.emplace_back(QueryFigures{range, {}});
    for (const traces::StatisticName& s : traces::kStatistics)
      if ((range.statistics & s.bit) != 0) figures.values.push_back({s.name, sum(counted_as(s.bit))});
  }
  return all;
}

std::vector<QueryFigures> query_figures(const std::vector<QueryRange>& ranges,
                                        std::span<const std::uint64_t> samples_passed) {
  std::vector<QueryFigures> all;
  all.reserve(ranges.size());
  for (const QueryRange& range : ranges) {
    if (range.type == traces::QueryType::kOcclusion) {
      const auto draws = samples_passed.subspan(range.first_draw, range.draws);
      all.push_back(occlusion(range, std::accumulate(draws.begin(), draws.end(), std::uint64_t{0})));
      continue;
    }
    QueryFigures& figures = all.emplace_back(QueryFigures{range, {}});
    for (const traces::StatisticName& s : traces::kStatistics)
      if ((range.statistics & s.bit) != 0) figures.values.push_back({s.name, std::nullopt});
  }
  return all;
}

}  // namespace quadrille::pipeline
