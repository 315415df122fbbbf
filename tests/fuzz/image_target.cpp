/// Image files, whatever their first bytes say they are.
#include "scenes/image/image_io.h"
#include "scenes/image/texture_file.h"
#include "tests/fuzz/memory_file.h"
#include "tests/fuzz/refusal.h"
#include "tests/fuzz/targets.h"

namespace quadrille::fuzz {

void run_image(Bytes bytes) {
  static const MemoryFile file;
  done_or_refused("t.png", [&] { (void)scenes::decode_image(bytes, "t.png"); });
  if (scenes::is_texture_file(bytes))
    done_or_refused("t.ktx2", [&] { (void)scenes::finest_level(scenes::read_texture_file(bytes, "t.ktx2")); });
  file.put(bytes);
  done_or_refused(file.path(), [&] { (void)scenes::load_float_image(file.path()); });
}

}  // namespace quadrille::fuzz
