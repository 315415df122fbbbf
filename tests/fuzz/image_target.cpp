/// Image files, whatever their first bytes say they are.
#include "scenes/image/image_io.h"
#include "tests/fuzz/memory_file.h"
#include "tests/fuzz/refusal.h"
#include "tests/fuzz/targets.h"

namespace quadrille::fuzz {

void run_image(Bytes bytes) {
  static const MemoryFile file;
  done_or_refused("t.png", [&] { (void)scenes::decode_image(bytes, "t.png"); });
  file.put(bytes);
  done_or_refused(file.path(), [&] { (void)scenes::load_float_image(file.path()); });
}

}  // namespace quadrille::fuzz
