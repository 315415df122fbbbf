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

/// A capture while it is read.
class Reading {
 public:
  explicit Reading(CaptureFile file) : file_(std::move(file)), recorder_(device_) {}

  /// Reads on until a frame is presented; false at the end of the file.
  bool read_frame() {
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
  [[nodiscard]] FrameRecorder& recorder() { return recorder_; }
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
    if (known->name == "QueueSubmit" || known->name == "QueueSubmit2") recorder_.submit(*call);
    else if (known->name == "QueuePresentKHR") recorder_.present(*call);
    else device_.apply(call);
    return recorder_.presented();
  }

  CaptureFile file_;
  Device device_;
  FrameRecorder recorder_;
  std::map<std::string, std::size_t> calls_;
};

std::string counted(const std::map<std::string, std::size_t>& reasons) {
  std::string text;
  std::size_t named = 0;
  for (const auto& [reason, count] : reasons) {
    if (named++ == kMostReasons) return text + fmt::format("; and {} more", reasons.size() - kMostReasons);
    text += fmt::format("{}{} (x{})", named == 1 ? "" : "; ", reason, count);
  }
  return text;
}

Import import_frame(CaptureFile file, const ImportOptions& options) {
  const std::string name = file.name();
  Reading reading(std::move(file));
  if (!reading.read_frame()) throw user_error("{}: it presents no frame", name);
  FrameRecorder& recorder = reading.recorder();
  Import made;
  made.skipped = recorder.unsupported();
  if (!made.skipped.empty() && !options.skip_unsupported)
    throw user_error("{}: not supported: {}; --skip-unsupported draws without it", name,
                     counted(made.skipped));
  made.notes = recorder.notes();
  try {
    made.stream = recorder.take();
    made.stream.name = name;
    traces::validate(made.stream);
  } catch (const UserError& error) { throw user_error("{}: {}", name, error.what()); }
  return made;
}

}  // namespace

Import import_capture(const std::string& path, const ImportOptions& options) {
  return import_frame(CaptureFile(path), options);
}
Import import_bytes(const std::string& name, std::vector<std::byte> bytes, const ImportOptions& options) {
  return import_frame(CaptureFile(name, std::move(bytes)), options);
}

std::string capture_info(const std::string& path) {
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

}  // namespace quadrille::capture
