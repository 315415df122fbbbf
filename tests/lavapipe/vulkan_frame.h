/// One command stream as Vulkan objects: uploaded once, recorded into one command buffer, submitted as often
/// as asked.
#pragma once

#include <map>
#include <tuple>
#include <vector>

#include "tests/lavapipe/stream_queries.h"
#include "tests/lavapipe/vulkan_device.h"
#include "tests/lavapipe/vulkan_queries.h"
#include "traces/command_stream.h"

namespace quadrille::lavapipe {

/// What shows the colours, or what they are resolved to.
[[nodiscard]] inline traces::ImagePart shown(const traces::ColorAttachmentUse& color) {
  return color.resolve == traces::kNone ? color.part() : color.resolve_part();
}

class VulkanFrame {
 public:
  /// Uploads and records. `device` and `stream` must outlive the frame, and so must `queries`, which are
  /// asked around each pass, in place of the stream's own.
  VulkanFrame(const VulkanDevice& device, const traces::CommandStream& stream,
              const PassQueries* queries = nullptr);

  void submit() const { device_.submit(commands_); }
  /// The attachments of the last pass and the storage buffers, as the last submission left them.
  [[nodiscard]] Rendered read_back() const;

 private:
  /// What a descriptor set holds, which is all that its layout depends on: binding -> type.
  struct ArrayShape {
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_MAX_ENUM;
    std::uint32_t count = 1;
    friend auto operator<=>(const ArrayShape&, const ArrayShape&) = default;  // NOLINT(modernize-use-nullptr)
  };
  using SetShape = std::map<std::uint32_t, ArrayShape>;  ///< by binding
  using SetShapes = std::vector<SetShape>;
  struct PipelineObjects {
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
  };
  struct Image {
    VkImage image = VK_NULL_HANDLE;
    VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;       ///< that shaders and copies read
    VkImageAspectFlags all_aspects = VK_IMAGE_ASPECT_COLOR_BIT;  ///< that it has
  };
  /// Of the attachments of a pass: the colours, then depth; and their samples a pixel.
  struct PassFormats {
    std::vector<traces::Format> formats;
    std::uint32_t samples = 1;
    friend auto operator<=>(const PassFormats&,
                            const PassFormats&) = default;  // NOLINT(modernize-use-nullptr)
  };
  /// A sampler, and whether it is for images of integers, which its border must be one of.
  using SamplerKey = std::pair<traces::Index, bool>;
  /// State that a stream sets piecemeal and Vulkan wants whole: a pipeline layout needs the shapes of all
  /// sets bound with it.
  struct Bound {
    const traces::BeginPass* pass = nullptr;
    traces::Index pipeline = traces::kNone;
    std::vector<traces::Index> sets;
    std::vector<std::byte> push_constants;
  };

  void upload_buffers();
  void read_back_buffers(Rendered& result) const;
  /// What a colour image of the last pass holds, row by row.
  [[nodiscard]] std::vector<models::PixelCode> read_target(const traces::ImagePart& part) const;
  /// Copies a level of an image of the last pass, of so many bytes a pixel, and waits for it.
  [[nodiscard]] HostBuffer copy_image(Cleanup& cleanup, const traces::ImagePart& part,
                                      std::size_t pixel_bytes) const;
  void upload_images();
  [[nodiscard]] VkSampler sampler_of(const SamplerKey& key);
  void upload_texels(const traces::Image& source, const Image& image);
  /// Texels that an attachment begins with: a buffer that each submission copies them from, at its begin.
  struct HeldTexels {
    VkBuffer buffer = VK_NULL_HANDLE;
    std::vector<VkBufferImageCopy> copies;
  };
  void hold_texels(traces::Index index);
  void bring_texels(traces::Index index, const HeldTexels& held);
  /// Levels and layers that a view sees.
  struct Seen {
    traces::ImagePart finest;
    std::uint32_t levels = 1;
    traces::ViewKind kind = traces::ViewKind::k2D;
    std::uint32_t layers = 1;
    models::ComponentMapping components = models::kSameComponents;
    friend auto operator<=>(const Seen&, const Seen&) = default;  // NOLINT(modernize-use-nullptr)
  };
  [[nodiscard]] VkImageView view_of(const Seen& seen);
  /// What a pass draws to.
  [[nodiscard]] Seen attached(const traces::ImagePart& part) const;
  void create_descriptor_sets();

  [[nodiscard]] SetShape shape_of(traces::Index set) const;
  [[nodiscard]] VkDescriptorSetLayout set_layout(const SetShape& shape);
  [[nodiscard]] VkPipelineLayout pipeline_layout(const SetShapes& shapes);
  /// `by_sample`: of a fragment shader whose pipeline shades by sample.
  [[nodiscard]] VkShaderModule shader_module(traces::Index shader, bool by_sample = false);
  [[nodiscard]] const PipelineObjects& pipeline_for(const Bound& bound);
  [[nodiscard]] VkPipeline create_pipeline(const traces::Pipeline& pipeline, const PassFormats& pass,
                                           VkPipelineLayout layout);
  [[nodiscard]] PassFormats formats_of(const traces::BeginPass& pass) const;

  void record();
  void begin_pass(const traces::BeginPass& pass);
  void move(const traces::ImagePart& part, VkImageLayout layout);
  [[nodiscard]] VkRenderingAttachmentInfo attach(const traces::AttachmentUse& use, VkImageLayout layout,
                                                 const VkClearValue& clear);
  void end_pass();
  void resolve(const traces::ColorAttachmentUse& use);
  void draw(const traces::Draw& draw);

  const VulkanDevice& device_;
  const traces::CommandStream& stream_;
  Cleanup cleanup_;
  const PassQueries* queries_;
  StreamQueries stream_queries_;
  std::uint32_t passes_ = 0;  ///< recorded
  std::vector<VkBuffer> buffers_;
  std::vector<Image> images_;
  std::map<traces::Index, HeldTexels> held_;            ///< by attachment
  std::map<traces::ImagePart, VkImageLayout> layouts_;  ///< of attachments, at this point of the recording
  std::map<Seen, VkImageView> views_;
  std::map<SamplerKey, VkSampler> samplers_;
  std::vector<VkDescriptorSet> descriptor_sets_;
  std::map<SetShape, VkDescriptorSetLayout> set_layouts_;
  std::map<SetShapes, VkPipelineLayout> pipeline_layouts_;
  std::map<std::pair<traces::Index, bool>, VkShaderModule> modules_;  ///< by shader, and whether by sample
  /// by pipeline, formats of the pass, set shapes
  std::map<std::tuple<traces::Index, PassFormats, SetShapes>, PipelineObjects> pipelines_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  Bound bound_;
};

}  // namespace quadrille::lavapipe
