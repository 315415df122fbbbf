/// Parameters of copies, blits and resolves, and the structures that these have. Calls whose names end with 2
/// have behind one pointer what the others have themselves. [VK registry]
#include <vulkan/vulkan_core.h>

#include "traces/capture/schema.h"

namespace quadrille::capture {
namespace {

// clang-format off: a row an entry
constexpr SchemaRow kCalls[] = {
    {"CmdCopyBuffer", "commandBuffer:u64 srcBuffer:u64 dstBuffer:u64 regionCount:u32 pRegions:*BufferCopy"},
    {"CmdCopyImage",
     "commandBuffer:u64 srcImage:u64 srcImageLayout:u32 dstImage:u64 dstImageLayout:u32 "
     "regionCount:u32 pRegions:*ImageCopy"},
    {"CmdCopyBufferToImage",
     "commandBuffer:u64 srcBuffer:u64 dstImage:u64 dstImageLayout:u32 "
     "regionCount:u32 pRegions:*BufferImageCopy"},
    {"CmdCopyImageToBuffer",
     "commandBuffer:u64 srcImage:u64 srcImageLayout:u32 dstBuffer:u64 "
     "regionCount:u32 pRegions:*BufferImageCopy"},
    {"CmdBlitImage",
     "commandBuffer:u64 srcImage:u64 srcImageLayout:u32 dstImage:u64 dstImageLayout:u32 "
     "regionCount:u32 pRegions:*ImageBlit filter:u32"},
    {"CmdResolveImage",
     "commandBuffer:u64 srcImage:u64 srcImageLayout:u32 dstImage:u64 dstImageLayout:u32 "
     "regionCount:u32 pRegions:*ImageResolve"},
    {"CmdCopyBuffer2", "commandBuffer:u64 pCopyBufferInfo:*CopyBufferInfo2"},
    {"CmdCopyImage2", "commandBuffer:u64 pCopyImageInfo:*CopyImageInfo2"},
    {"CmdCopyBufferToImage2", "commandBuffer:u64 pCopyBufferToImageInfo:*CopyBufferToImageInfo2"},
    {"CmdCopyImageToBuffer2", "commandBuffer:u64 pCopyImageToBufferInfo:*CopyImageToBufferInfo2"},
    {"CmdBlitImage2", "commandBuffer:u64 pBlitImageInfo:*BlitImageInfo2"},
    {"CmdResolveImage2", "commandBuffer:u64 pResolveImageInfo:*ResolveImageInfo2"},
};
constexpr SchemaRow kStructures[] = {
    {"BufferCopy", "srcOffset:u64 dstOffset:u64 size:u64"},
    {"BufferImageCopy",
     "bufferOffset:u64 bufferRowLength:u32 bufferImageHeight:u32 "
     "imageSubresource:ImageSubresourceLayers imageOffset:Offset3D imageExtent:Extent3D"},
    {"ImageBlit",
     "srcSubresource:ImageSubresourceLayers srcOffsets:*Offset3D "
     "dstSubresource:ImageSubresourceLayers dstOffsets:*Offset3D"},
    {"ImageCopy",
     "srcSubresource:ImageSubresourceLayers srcOffset:Offset3D "
     "dstSubresource:ImageSubresourceLayers dstOffset:Offset3D extent:Extent3D"},
    {"ImageResolve",
     "srcSubresource:ImageSubresourceLayers srcOffset:Offset3D "
     "dstSubresource:ImageSubresourceLayers dstOffset:Offset3D extent:Extent3D"},
    {"BufferCopy2", "sType:u32 pNext:next srcOffset:u64 dstOffset:u64 size:u64",
     VK_STRUCTURE_TYPE_BUFFER_COPY_2},
    {"BufferImageCopy2",
     "sType:u32 pNext:next bufferOffset:u64 bufferRowLength:u32 bufferImageHeight:u32 "
     "imageSubresource:ImageSubresourceLayers imageOffset:Offset3D imageExtent:Extent3D",
     VK_STRUCTURE_TYPE_BUFFER_IMAGE_COPY_2},
    {"ImageBlit2",
     "sType:u32 pNext:next srcSubresource:ImageSubresourceLayers srcOffsets:*Offset3D "
     "dstSubresource:ImageSubresourceLayers dstOffsets:*Offset3D",
     VK_STRUCTURE_TYPE_IMAGE_BLIT_2},
    {"ImageCopy2",
     "sType:u32 pNext:next srcSubresource:ImageSubresourceLayers srcOffset:Offset3D "
     "dstSubresource:ImageSubresourceLayers dstOffset:Offset3D extent:Extent3D",
     VK_STRUCTURE_TYPE_IMAGE_COPY_2},
    {"ImageResolve2",
     "sType:u32 pNext:next srcSubresource:ImageSubresourceLayers srcOffset:Offset3D "
     "dstSubresource:ImageSubresourceLayers dstOffset:Offset3D extent:Extent3D",
     VK_STRUCTURE_TYPE_IMAGE_RESOLVE_2},
    {"CopyBufferInfo2",
     "sType:u32 pNext:next srcBuffer:u64 dstBuffer:u64 regionCount:u32 pRegions:*BufferCopy2",
     VK_STRUCTURE_TYPE_COPY_BUFFER_INFO_2},
    {"CopyImageInfo2",
     "sType:u32 pNext:next srcImage:u64 srcImageLayout:u32 dstImage:u64 dstImageLayout:u32 "
     "regionCount:u32 pRegions:*ImageCopy2",
     VK_STRUCTURE_TYPE_COPY_IMAGE_INFO_2},
    {"CopyBufferToImageInfo2",
     "sType:u32 pNext:next srcBuffer:u64 dstImage:u64 dstImageLayout:u32 "
     "regionCount:u32 pRegions:*BufferImageCopy2",
     VK_STRUCTURE_TYPE_COPY_BUFFER_TO_IMAGE_INFO_2},
    {"CopyImageToBufferInfo2",
     "sType:u32 pNext:next srcImage:u64 srcImageLayout:u32 dstBuffer:u64 "
     "regionCount:u32 pRegions:*BufferImageCopy2",
     VK_STRUCTURE_TYPE_COPY_IMAGE_TO_BUFFER_INFO_2},
    {"BlitImageInfo2",
     "sType:u32 pNext:next srcImage:u64 srcImageLayout:u32 dstImage:u64 dstImageLayout:u32 "
     "regionCount:u32 pRegions:*ImageBlit2 filter:u32",
     VK_STRUCTURE_TYPE_BLIT_IMAGE_INFO_2},
    {"ResolveImageInfo2",
     "sType:u32 pNext:next srcImage:u64 srcImageLayout:u32 dstImage:u64 dstImageLayout:u32 "
     "regionCount:u32 pRegions:*ImageResolve2",
     VK_STRUCTURE_TYPE_RESOLVE_IMAGE_INFO_2},
};
// clang-format on

}  // namespace

std::span<const SchemaRow> copy_call_rows() { return kCalls; }
std::span<const SchemaRow> copy_structure_rows() { return kStructures; }

}  // namespace quadrille::capture
