/// From blocks to a frame.
#include "traces/capture/import.h"

#include <algorithm>
#include <iterator>
#include <vector>

#include "models/base/error.h"
#include "traces/capture/frame_recorder.h"
#include "traces/capture/vulkan_names.h"

namespace quadrille::capture {
namespace {

constexpr std::size_t kMostReasons = 12;  // that an error names

std::string counted(const std::map<std::string, std::size_t>& reasons) {
  std::string text;
  std::size_t named = 0;
  for (const auto& [reason, count] : reasons) {
    if (named++ == kMostReasons) return text + fmt::format("; and {} more", reasons.size() - kMostReasons);
    text += fmt::format("{}{} (x{})", named == 1 ? "" : "; ", reason, count);
  }
  return text;
}

}  // namespace

/// A capture while it is read.
class CaptureFrames::Reading {
 public:
  explicit Reading(CaptureFile file) : file_(std::move(file)) {}

  /// Reads on until a frame is presented; false at the end of the file.
  bool read_frame() {
    recorder_ = std::make_unique<FrameRecorder>(device_);
    while (std::optional<Block> block = file_.next()) {
      try {
        if (take(*block)) return true;
      } catch (const UserError& error) {
        const std::string call =
            block->kind == BlockKind::kCall ? fmt::format(" (vk{})", call_name(block->id)) : "";
        throw user_error("{}: block {}{}: {}", file_.name(), block->index, call, error.what());
      }
    }
    return false;
  }
  /// The frame, validated; none at the end of the file.
  [[nodiscard]] std::optional<Import> frame(const ImportOptions& options);
  [[nodiscard]] FrameRecorder& recorder() { return *recorder_; }
  [[nodiscard]] const std::string& name() const { return file_.name(); }
  [[nodiscard]] const std::map<std::string, std::size_t>& calls() const { return calls_; }

 private:
  /// True when the frame is complete.
  bool take(const Block& block) {
    if (block.kind == BlockKind::kMetaData) device_.write(block);
    if (block.kind != BlockKind::kCall) return false;
    const std::string_view name = call_name(block.id);
    ++calls_[name.empty() ? fmt::format("call {:#x}", block.id) : "vk" + std::string(name)];
    const Structure* known = call_parameters(name);
    if (known == nullptr) {
      device_.pass_by(name, block.data);
      return false;
    }
    const auto call = std::make_shared<Call>(
        Call{block.index, known->name, read_parameters(*known, block.data), block.held});
    if (known->name == "QueueSubmit" || known->name == "QueueSubmit2") recorder_->submit(*call);
    else if (known->name == "QueuePresentKHR") recorder_->present(*call);
    else device_.apply(call);
    return recorder_->presented();
  }

  CaptureFile file_;
  Device device_;
  std::unique_ptr<FrameRecorder> recorder_;  ///< of the latest frame
  std::map<std::string, std::size_t> calls_;
};

std::optional<Import> CaptureFrames::Reading::frame(const ImportOptions& options) {
  if (!read_frame()) return std::nullopt;
  std::optional<Import> made(std::in_place);
  made->skipped = recorder_->unsupported();
  if (!made->skipped.empty() && !options.skip_unsupported)
    throw user_error("{}: not supported: {}; --skip-unsupported draws without it", name(),
                     counted(made->skipped));
  try {
    made->stream = recorder_->take();
    made->notes = recorder_->notes();
    made->stream.name = name();
    traces::validate(made->stream);
  } catch (const UserError& error) { throw user_error("{}: {}", name(), error.what()); }
  return made;
}

CaptureFrames::CaptureFrames(const std::string& path, const ImportOptions& options)
    : reading_(std::make_unique<Reading>(CaptureFile(path))), options_(options) {}
CaptureFrames::CaptureFrames(const std::string& name, std::vector<std::byte> bytes,
                             const ImportOptions& options)
    : reading_(std::make_unique<Reading>(CaptureFile(name, std::move(bytes)))), options_(options) {}
CaptureFrames::~CaptureFrames() = default;

std::optional<Import> CaptureFrames::next() { return reading_->frame(options_); }
void CaptureFrames::keep(const traces::FrameContents& contents) { reading_->recorder().keep(contents); }

std::size_t count_frames(const std::string& path) {
  CaptureFile file(path);
  std::size_t frames = 0;
  while (const std::optional<Block> block = file.next())
    frames += block->kind == BlockKind::kCall && call_name(block->id) == "QueuePresentKHR" ? 1u : 0u;
  return frames;
}

namespace {

Import first_of(CaptureFrames& frames, const std::string& name) {
  std::optional<Import> first = frames.next();
  if (!first) throw user_error("{}: it presents no frame", name);
  return *std::move(first);
}

}  // namespace

Import import_capture(const std::string& path, const ImportOptions& options) {
  CaptureFrames frames(path, options);
  return first_of(frames, path);
}
Import import_bytes(const std::string& name, std::vector<std::byte> bytes, const ImportOptions& options) {
  CaptureFrames frames(name, std::move(bytes), options);
  return first_of(frames, name);
}

std::string CaptureFrames::info(const std::string& path) {
  Reading reading{CaptureFile(path)};
  const bool whole = reading.read_frame();
  std::string text = fmt::format("{}: a capture of gfxreconstruct\n", path);
  std::vector<std::pair<std::string, std::size_t>> calls(reading.calls().begin(), reading.calls().end());
  std::ranges::stable_sort(calls, [](const auto& a, const auto& b) { return a.second > b.second; });
  for (const auto& [name, count] : calls) text += fmt::format("{:8} {}\n", count, name);
  const auto& unsupported = reading.recorder().unsupported();
  text += !whole                ? "it presents no frame\n"
          : unsupported.empty() ? "all commands of its frame are supported\n"
                                : "not supported of its frame:\n";
  for (const auto& [reason, count] : unsupported) text += fmt::format("{:8} {}\n", count, reason);
  return text;
}

std::string capture_info(const std::string& path) { return CaptureFrames::info(path); }

}  // namespace quadrille::capture
