#include "hw/base/work_log.h"

namespace quadrille::hw {

// Not inline: in units that keep no log, what is left of it is a test.
void WorkLog::turn_to(Work work) {
  if (work == now_) return;
  if (work.draw != now_.draw) draw_rows_.note(row_of(now_.draw));
  const std::uint32_t cell = screen_.cell_of(work);
  if (cell != cell_) cell_rows_.note(cell_);
  now_ = work;
  cell_ = cell;
}

void WorkLog::settle() {
  draw_rows_.note(row_of(now_.draw));
  cell_rows_.note(cell_);
}

}  // namespace quadrille::hw
