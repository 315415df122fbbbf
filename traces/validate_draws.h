/// Walks the commands as an executor would, keeping the bound state, and refuses the first command that an
/// executor could not carry out.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "traces/command_stream.h"
#include "traces/validate_queries.h"

namespace quadrille::traces {

inline constexpr std::uint32_t kMaxVertexBindings = 16;
inline constexpr std::uint32_t kMaxDescriptorSets = 4;

class CommandWalk {
 public:
  explicit CommandWalk(const CommandStream& stream) : stream_(stream), queries_(stream.query_pools) {}
  /// Throws `UserError` naming the command.
  void run();

 private:
  struct VertexStream {
    Index buffer = kNone;
    std::uint64_t offset = 0;
  };
  struct VertexRange {
    std::uint64_t first = 0, last = 0;
  };

  void visit(const BeginPass& c);
  void visit(const EndPass& c);
  void visit(const BindPipeline& c);
  void visit(const BindDescriptorSet& c);
  void visit(const BindVertexBuffer& c);
  void visit(const BindIndexBuffer& c);
  void visit(const PushConstants& c);
  void visit(const SetViewport& c);
  void visit(const SetScissor& c);
  void visit(const Draw& c);
  void visit(const BeginQuery& c) { queries_.begin(c, at_, pass_ != nullptr); }
  void visit(const EndQuery& c) { queries_.end(c, at_, pass_ != nullptr); }

  void check_resolve(const ColorAttachmentUse& color);
  void check_exists(std::uint32_t image, const char* what) const;
  void check_attachment(const AttachmentUse& use, ImageUsage usage, const char* what);
  void check_part(const ImagePart& part, const char* what);
  void check_transparency(const BeginPass& pass) const;
  void check_draw_state() const;
  void check_integers() const;
  void check_draw_order();
  void check_scissor(const SetScissor& scissor) const;
  void check_index(std::uint32_t index, const char* what) const;
  void count_vertices(const Draw& draw);
  /// None: all its indices only end strips.
  [[nodiscard]] std::optional<VertexRange> vertex_range(const Draw& draw);
  [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> index_range(const Draw& draw);
  void check_attribute(const Pipeline& pipeline, const VertexAttribute& attribute, VertexRange vertices,
                       VertexRange instances) const;

  const CommandStream& stream_;
  std::size_t at_ = 0;  ///< command index, for messages
  std::uint64_t vertices_ = 0;
  std::size_t passes_ = 0;
  const BeginPass* pass_ = nullptr;  ///< that has begun and not ended
  const BeginPass* last_ = nullptr;
  PassTarget target_;
  bool drew_any_order_ = false;            ///< the pass has an order-independent draw
  std::uint32_t samples_ = 1;              ///< a pixel, of the pass
  std::set<ImagePart> attached_, stored_;  ///< in this pass; by an earlier one
  Index pipeline_ = kNone;
  QueryWalk queries_;
  std::array<VertexStream, kMaxVertexBindings> vertex_streams_;
  BindIndexBuffer indices_;
  std::array<bool, models::kMaxViewports> viewports_{};  ///< that are set
  std::array<std::optional<SetScissor>, models::kMaxViewports> scissors_;
  std::map<std::tuple<Index, std::uint64_t, IndexType, std::uint32_t, bool>,
           /// scanned once
           std::pair<std::uint32_t, std::uint32_t>>
      index_ranges_;
};

}  // namespace quadrille::traces
