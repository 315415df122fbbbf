/// What a frame leaves behind: the attachments that its passes stored, the buffers that its programs wrote.
/// Another frame may begin with it.
#pragma once

#include <cstddef>
#include <vector>

#include "traces/command_stream.h"

namespace quadrille::traces {

struct FrameContents {
  /// A level of a layer of an attachment of one sample a pixel, as `Image::texels` have it.
  struct Part {
    ImagePart part;
    std::vector<std::byte> texels;
  };
  struct Written {
    Index buffer = kNone;
    std::vector<std::byte> data;
  };
  std::vector<Part> parts;
  std::vector<Written> buffers;
};

}  // namespace quadrille::traces
