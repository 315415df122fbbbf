#include "pipeline/report/texture_use.h"

#include "hw/memory/memory_channel.h"
#include "hw/texture/texture_unit.h"
#include "pipeline/driver/frame_builder.h"
#include "pipeline/machine/machine.h"
#include "pipeline/report/figures.h"

#include <algorithm>

namespace quadrille::pipeline {
namespace {

/// Bytes that memory read for the texture units, by texture; what lies in none is of none.
std::uint64_t add_memory_bytes(const hw::MemoryChannel& channel, std::vector<TextureFigures>& textures) {
  std::uint64_t elsewhere = 0;
  for (const auto& [line, bytes] : *channel.texture_lines()) {
    const std::uint64_t address = std::uint64_t{line} * models::kLineBytes;
    const auto in = [&](const TextureFigures& t) {
      return address >= t.image.begin && address < t.image.end;
    };
    const auto found = std::ranges::find_if(textures, in);
    (found == textures.end() ? elsewhere : found->memory_bytes) += bytes;
  }
  return elsewhere;
}

}  // namespace

void keep_texture_use(const Machine& machine, const DeviceFrame& frame) {
  for (hw::TextureUnit* unit : machine.all<hw::TextureUnit>()) unit->keep_use(frame.sampled.size());
  for (hw::MemoryChannel* channel : machine.all<hw::MemoryChannel>()) channel->keep_texture_lines();
}

void collect_texture_use(const Machine& machine, const DeviceFrame& frame, Figures& figures) {
  std::vector<TextureFigures>& textures = figures.textures.emplace();
  textures.reserve(frame.sampled.size());
  for (const SampledImage& image : frame.sampled) textures.push_back({image, {}});
  hw::TextureUse sum;
  std::uint64_t lanes = 0, look_ups = 0, misses = 0, bytes = 0, memory = 0, counted_by_memory = 0;
  for (const hw::TextureUnit* unit : machine.all<hw::TextureUnit>()) {
    const hw::TextureUseLog* log = unit->use();
    QUADRILLE_CHECK(log != nullptr, "{} kept no use of textures", unit->name());
    for (std::size_t i = 0; i < textures.size(); ++i) {
      textures[i].use.add(log->by_texture()[i]);
      sum.add(log->by_texture()[i]);
    }
    lanes += unit->lanes().value();
    look_ups += unit->cache_stats().requests.value();
    misses += unit->cache_stats().misses.value();
    bytes += unit->port_stats().read_bytes.value();
  }
  for (const hw::MemoryChannel* channel : machine.all<hw::MemoryChannel>()) {
    memory += add_memory_bytes(*channel, textures);
    counted_by_memory += channel->bytes_of(hw::MemoryClient::kTexture).value();
  }
  for (const TextureFigures& t : textures) memory += t.memory_bytes;
  const auto law = [&](const char* text, const char* left, const char* right, std::uint64_t a,
                       std::uint64_t b) {
    figures.checks.push_back({text, left, right, a, b});
  };
  law("lanes of all textures = of the texture units", "textures.lanes", "texture.lanes", sum.lanes, lanes);
  law("look-ups of all textures = of the texture caches", "textures.look_ups", "texture.cache_requests",
      sum.look_ups, look_ups);
  law("misses of all textures = of the texture caches", "textures.misses", "texture.cache_misses", sum.misses,
      misses);
  law("bytes of all textures = asked of the L2 cache", "textures.read_bytes", "texture.read_bytes",
      sum.read_bytes, bytes);
  law("bytes of all textures and of none = read by memory for the texture units", "textures.memory_bytes",
      "memory.read_bytes_texture", memory, counted_by_memory);
}

}  // namespace quadrille::pipeline
