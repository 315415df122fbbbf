#include "pipeline/driver/storage_binder.h"

#include "models/base/descriptor_binding.h"
#include "models/base/error.h"

#include <algorithm>

namespace quadrille::pipeline {

const traces::StorageBinding& StorageBinder::bound(const models::Program& program,
                                                   const models::BufferBinding& use,
                                                   const std::map<std::uint32_t, traces::Index>& sets) const {
  if (const auto set = sets.find(use.set); set != sets.end()) {
    const auto& buffers = stream_.descriptor_sets[set->second].buffers;
    const auto found = std::ranges::find(buffers, use.binding, &traces::StorageBinding::binding);
    if (found != buffers.end()) return *found;
  }
  throw user_error("{}: no storage buffer is bound at set {}, binding {}", program.name, use.set,
                   models::binding_text(use.binding));
}

void StorageBinder::bind(hw::ProgramState& state, const std::map<std::uint32_t, traces::Index>& sets) {
  const models::Program& program = *state.program;
  for (const models::BufferBinding& use : program.buffers) {
    const traces::StorageBinding& range = bound(program, use, sets);
    // Until `finish`, the view names the stream's buffer.
    state.buffers.push_back({resources_.buffer(range.buffer) + range.offset, range.range, range.buffer});
  }
  for (const models::Instruction& i : program.code)
    if (models::writes_buffer(i.op)) written_by_[state.buffers[i.imm].buffer] = program.name;
}

std::vector<WrittenBuffer> StorageBinder::finish(hw::Frame& frame, models::StorageMemory& storage) {
  std::vector<WrittenBuffer> written;
  std::vector<std::uint32_t> watched(stream_.buffers.size(), models::StorageView::kReadOnly);
  for (traces::Index b = 0; b < stream_.buffers.size(); ++b) {
    if (written_by_[b].empty()) continue;
    const traces::Buffer& buffer = stream_.buffers[b];
    if (const auto read = reads_.find(b); read != reads_.end())
      throw user_error("buffer '{}': program {} writes it, and a draw reads it as {}, which is not supported",
                       buffer.name, written_by_[b], read->second);
    written.push_back({b, resources_.buffer(b), buffer.data.size()});
    watched[b] = storage.watch(buffer.name, written.back().address, written.back().bytes);
  }
  for (hw::DrawState& draw : frame.draws) {
    for (hw::ProgramState* state : {&draw.vertex, &draw.fragment})
      for (models::StorageView& view : state->buffers) view.buffer = watched[view.buffer];
    draw.meets_written_memory = std::ranges::any_of(
        draw.fragment.buffers,
        [](const models::StorageView& view) { return view.buffer != models::StorageView::kReadOnly; });
  }
  return written;
}

}  // namespace quadrille::pipeline
