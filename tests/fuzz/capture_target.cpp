/// Captures of gfxreconstruct: blocks, calls, the device's side, and the stream that a frame becomes.
#include "tests/fuzz/refusal.h"
#include "tests/fuzz/targets.h"
#include "tests/fuzz/tiny_frame.h"
#include "traces/capture/import.h"

namespace quadrille::fuzz {

void run_capture(Bytes bytes) {
  capture::Import made;
  const auto import = [&] {
    made = capture::import_bytes("t.gfxr", {bytes.begin(), bytes.end()}, {.skip_unsupported = true});
  };
  if (!done_or_refused("t.gfxr", import)) return;
  done_or_refused("", [&] { draw_if_small(made.stream); });
}

}  // namespace quadrille::fuzz
