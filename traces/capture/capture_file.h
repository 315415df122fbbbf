/// A file of gfxreconstruct, block by block: what the capture layer wrote of a program's calls, and of the
/// memory that they worked on. [GFXR #blocks]
///
/// A file is a header, options, and blocks. A block is a call with its encoded parameters, a piece of memory,
/// or a mark. Blocks may be compressed by LZ4 or Zstandard; here they are expanded, one at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace quadrille::capture {

enum class BlockKind : std::uint8_t {
  kFrameMark,  ///< a frame ends
  kStateMark,  ///< what was there before the frame begins (1) or ends (2)
  kMetaData,   ///< memory and what else the calls do not say
  kCall,       ///< a call of Vulkan
  kOther       ///< text of the tools
};

/// Kinds of meta data that hold something of the frame. [GFXR #metadata]
inline constexpr std::uint32_t kFillMemory = 2, kInitBuffer = 7, kInitImage = 8, kDeviceProperties = 11;

struct Block {
  std::uint64_t index = 0;  ///< in the file, from 0
  BlockKind kind = BlockKind::kOther;
  std::uint32_t id = 0;  ///< of the call, of the meta data, or of the mark
  /// Parameters of a call; of meta data what follows its header. Expanded.
  std::span<const std::byte> data;
  std::vector<std::uint64_t> numbers;            ///< of meta data: its header's numbers behind the thread
  std::shared_ptr<std::vector<std::byte>> held;  ///< where `data` lies if it was compressed
};

/// Reads a file's blocks in order. Every error is a `UserError` with the file and the block.
class CaptureFile {
 public:
  explicit CaptureFile(const std::string& path);
  CaptureFile(std::string name, std::vector<std::byte> bytes);
  /// The next block; none at the end of the file. What it spans stays as long as this object and the block's
  /// `held`.
  [[nodiscard]] std::optional<Block> next();
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  void read_header();
  [[nodiscard]] Block read_block(std::uint32_t type, std::span<const std::byte> body);
  void read_call(Block& block, std::span<const std::byte> body, bool compressed);
  void read_meta_data(Block& block, std::span<const std::byte> body, bool compressed);
  void expand(Block& block, std::span<const std::byte> packed, std::uint64_t size);

  std::string name_;
  std::vector<std::byte> bytes_;
  std::size_t at_ = 0;
  std::uint64_t index_ = 0, expanded_ = 0;
  std::uint32_t compression_ = 0;
};

/// A number of the file: little-endian, at any address. Throws `UserError` with `place` if there are too few
/// bytes.
template <class T>
[[nodiscard]] T take_number(std::span<const std::byte>& bytes, const std::string& place);
extern template std::uint32_t take_number(std::span<const std::byte>&, const std::string&);
extern template std::uint64_t take_number(std::span<const std::byte>&, const std::string&);

}  // namespace quadrille::capture
