/// `quadrille render F.gfxr --frames N`: frames of a capture, with memory carried from one to the next.
///
/// What a frame leaves does not depend on a machine. So this process renders each frame without time for its
/// contents, imports the next one with them, and forks the process that draws it: frames may still be drawn
/// at the same time.
#include <fmt/format.h>

#include "cli/command.h"
#include "cli/frame_rows.h"
#include "models/base/error.h"
#include "pipeline/frame_contents.h"
#include "traces/capture/import.h"

namespace quadrille::cli {
namespace {

class CaptureChain {
 public:
  CaptureChain(const SceneArguments& scene, const models::Precision& precision)
      : scene_(scene),
        precision_(precision),
        frames_(scene.scene, capture::ImportOptions{.skip_unsupported = scene.skip_unsupported}) {}

  /// Goes to the next frame. Throws `UserError`.
  void advance() {
    if (started_) keep();
    started_ = true;
    std::optional<capture::Import> import = frames_.next();
    if (!import) throw user_error("{}: it ends before the next frame", scene_.scene);
    whole_ = scene_.take_import(*std::move(import));
  }
  /// The frame as it is drawn.
  [[nodiscard]] SceneArguments::Loaded frame() const {
    SceneArguments::Loaded drawn = whole_;
    scene_.change(drawn.stream);
    return drawn;
  }

 private:
  /// What `--draws` and `--pass` leave out of a picture has left its contents all the same.
  void keep() {
    try {
      frames_.keep(pipeline::contents_after(whole_.stream, precision_));
    } catch (const UserError& error) {
      const std::string_view text = error.what();
      if (text.find(scene_.scene) != std::string_view::npos) throw;
      throw user_error("{}: {}", scene_.scene, text);
    }
  }

  const SceneArguments& scene_;
  const models::Precision precision_;
  capture::CaptureFrames frames_;
  SceneArguments::Loaded whole_;  ///< the latest frame
  bool started_ = false;
};

}  // namespace

SequenceResult draw_capture_frames(const SceneArguments& scene, const FrameArguments& frames,
                                   const std::string& about, const models::Precision& precision,
                                   const Tables& tables, const DrawFrame& draw, const TakePicture& take) {
  const std::size_t there = capture::count_frames(scene.scene);
  const std::int64_t wanted = frames.count();
  if (static_cast<std::uint64_t>(wanted) > there)
    throw user_error("--frames: {} holds {} frame{}; legal are 1..{}", scene.scene, there,
                     there == 1 ? "" : "s", there);
  CaptureChain chain(scene, precision);
  chain.advance();
  const traces::PassTarget size = traces::shown_target(chain.frame().stream);
  tables.print(fmt::format("FRAMES  {}, {} of {} frames, {}x{}, {}\n{}", scene.scene, wanted, there,
                           size.width, size.height, about, frames_head()));
  FrameRows rows({wanted, 25, [](std::int64_t) { return FrameLabels{}; }}, tables, take);
  std::vector<studies::ChildWork> works;
  for (std::int64_t i = 0; i < wanted; ++i)
    works.push_back({[&chain, &draw, i] { return sent(draw(chain.frame(), i)); },
                     {kFrameSeconds, 0},
                     [&chain, i] {
                       if (i > 0) chain.advance();
                     }});
  rows.run(works, frames.job_count());
  return rows.result({{"scene", scene.scene}, {"animation_s", nullptr}, {"notes", Json::array()}});
}

}  // namespace quadrille::cli
