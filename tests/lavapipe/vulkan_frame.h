/// One command stream as Vulkan objects: uploaded once, recorded into one command buffer, submitted as often
/// as asked.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "tests/lavapipe/vulkan_device.h"
#include "tests/lavapipe/vulkan_queries.h"
#include "traces/command_stream.h"

namespace quadrille::lavapipe {

class VulkanFrame {
 public:
  /// Uploads and records. `device` and `stream` must outlive the frame, and so must `queries`, which are
  /// asked around each pass.
  VulkanFrame(const VulkanDevice& device, const traces::CommandStream& stream,
              const PassQueries* queries = nullptr);

  void submit() const { device_.submit(commands_); }
  /// The attachments of the last pass, as the last submission left them.
  [[nodiscard]] Rendered read_back() const;

 private:
  /// What a descriptor set holds, which is all that its layout depends on: binding -> type.
  using SetShape = std::map<std::uint32_t, VkDescriptorType>;
  using SetShapes = std::vector<SetShape>;
  struct PipelineObjects {
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
  };
  struct Target {
    DeviceImage color, depth;
  };
  /// State that a stream sets piecemeal and Vulkan wants whole: a pipeline layout needs the shapes of all
  /// sets bound with it.
  struct Bound {
    traces::Index target = 0, pipeline = traces::kNone;
    std::vector<traces::Index> sets;
    std::vector<std::byte> push_constants;
  };

  void upload_buffers();
  void upload_images();
  void create_samplers();
  void create_targets();
  void create_descriptor_sets();

  [[nodiscard]] SetShape shape_of(traces::Index set) const;
  [[nodiscard]] VkDescriptorSetLayout set_layout(const SetShape& shape);
  [[nodiscard]] VkPipelineLayout pipeline_layout(const SetShapes& shapes);
  [[nodiscard]] VkShaderModule shader_module(traces::Index shader);
  [[nodiscard]] const PipelineObjects& pipeline_for(const Bound& bound);
  [[nodiscard]] VkPipeline create_pipeline(const traces::Pipeline& pipeline,
                                           const traces::RenderTarget& target, VkPipelineLayout layout);

  void record();
  void begin_pass(const traces::BeginPass& pass);
  void end_pass();
  void draw(const traces::Draw& draw);

  const VulkanDevice& device_;
  const traces::CommandStream& stream_;
  Cleanup cleanup_;
  const PassQueries* queries_;
  std::uint32_t passes_ = 0;  ///< recorded
  std::vector<VkBuffer> buffers_;
  std::vector<DeviceImage> images_;
  std::vector<VkSampler> samplers_;
  std::vector<Target> targets_;
  std::vector<VkDescriptorSet> descriptor_sets_;
  std::map<SetShape, VkDescriptorSetLayout> set_layouts_;
  std::map<SetShapes, VkPipelineLayout> pipeline_layouts_;
  std::map<traces::Index, VkShaderModule> modules_;
  /// by (pipeline, target), set shapes
  std::map<std::pair<std::pair<traces::Index, traces::Index>, SetShapes>, PipelineObjects> pipelines_;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  Bound bound_;
};

}  // namespace quadrille::lavapipe
