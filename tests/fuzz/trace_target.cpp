/// Trace files: decoding, the gate of `validate`, the driver and the functional renderer behind it.
#include "tests/fuzz/refusal.h"
#include "tests/fuzz/targets.h"
#include "tests/fuzz/tiny_frame.h"
#include "traces/trace_file.h"

namespace quadrille::fuzz {

void run_trace(Bytes bytes) {
  traces::CommandStream stream;
  if (!done_or_refused("t.qtrace", [&] { stream = traces::decode_trace(bytes, "t.qtrace"); })) return;
  const std::vector<std::byte> again = traces::encode_trace(stream);
  QUADRILLE_CHECK(traces::encode_trace(traces::decode_trace(again, "t.qtrace")) == again,
                  "what was read is not what is written");
  (void)traces::trace_info(stream);
  done_or_refused("", [&] { draw_if_small(stream); });
}

}  // namespace quadrille::fuzz
