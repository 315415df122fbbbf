#include "scenes/image/astc_encoder.h"

#include <astcenc.h>

#include <map>
#include <memory>
#include <utility>

#include "models/base/error.h"

namespace quadrille::scenes {
namespace {

void require(astcenc_error error, const char* what) {
  QUADRILLE_CHECK(error == ASTCENC_SUCCESS, "{}: {}", what, astcenc_get_error_string(error));
}

struct FreeContext {
  void operator()(astcenc_context* context) const { astcenc_context_free(context); }
};
using Context = std::unique_ptr<astcenc_context, FreeContext>;

/// Its tables take a while to make, so there is one for each size of blocks and thread.
astcenc_context* context_of(std::uint32_t width, std::uint32_t height) {
  thread_local std::map<std::pair<std::uint32_t, std::uint32_t>, Context> contexts;
  Context& kept = contexts[{width, height}];
  if (kept) return kept.get();
  astcenc_config config{};
  require(astcenc_config_init(ASTCENC_PRF_LDR_SRGB, width, height, 1, ASTCENC_PRE_MEDIUM, 0, &config),
          "astcenc_config_init");
  astcenc_context* made = nullptr;
  constexpr unsigned kThreads = 1;
  require(astcenc_context_alloc(&config, kThreads, &made), "astcenc_context_alloc");
  kept.reset(made);
  return made;
}

}  // namespace

std::vector<std::byte> encode_astc(std::span<const std::byte> rgba, std::uint32_t width, std::uint32_t height,
                                   std::uint32_t block_width, std::uint32_t block_height) {
  QUADRILLE_CHECK(rgba.size() == std::size_t{4} * width * height, "{} bytes for {} x {} texels", rgba.size(),
                  width, height);
  constexpr std::size_t kBlockBytes = 16;
  std::vector<std::byte> texels(rgba.begin(), rgba.end());  // the encoder takes what it could write to
  void* slice = texels.data();
  astcenc_image image{width, height, 1, ASTCENC_TYPE_U8, &slice};
  const std::size_t columns = (width + block_width - 1) / block_width,
                    rows = (height + block_height - 1) / block_height;
  std::vector<std::byte> blocks(kBlockBytes * columns * rows);
  const astcenc_swizzle same{ASTCENC_SWZ_R, ASTCENC_SWZ_G, ASTCENC_SWZ_B, ASTCENC_SWZ_A};
  astcenc_context* const context = context_of(block_width, block_height);
  require(astcenc_compress_image(context, &image, &same, reinterpret_cast<std::uint8_t*>(blocks.data()),
                                 blocks.size(), 0),
          "astcenc_compress_image");
  require(astcenc_compress_reset(context), "astcenc_compress_reset");
  return blocks;
}

}  // namespace quadrille::scenes
