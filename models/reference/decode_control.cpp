/// Decoding control flow: functions are inlined, blocks placed in structured order, phis become moves on
/// edges.
#include <set>
#include <spirv/unified1/spirv.hpp>

#include "models/base/error.h"
#include "models/reference/decode.h"
#include "models/reference/handlers.h"

namespace quadrille::models::reference {
namespace {

constexpr int kMaxCallDepth = 64;
constexpr std::size_t kMaxCode = std::size_t{1} << 20;

bool is_kill(std::uint32_t op) { return op == spv::OpKill || op == spv::OpTerminateInvocation; }

bool overlaps(Slot a, Slot b, std::uint32_t n) { return a < b + n && b < a + n; }

}  // namespace

std::uint32_t Decoder::new_label() {
  label_block_.push_back(kNoNumber);
  return static_cast<std::uint32_t>(label_block_.size() - 1);
}

void Decoder::begin_block(std::uint32_t label) {
  label_block_[label] = static_cast<std::uint32_t>(program_.blocks.size());
  program_.blocks.emplace_back().first = static_cast<std::uint32_t>(program_.code.size());
}

/// Closes the current block's straight code; its edges are added next.
void Decoder::end_block(BlockEnd end, Slot condition) {
  Block& block = program_.blocks.back();
  block.count = static_cast<std::uint32_t>(program_.code.size()) - block.first;
  block.end = end;
  block.condition = condition;
  block.first_edge = static_cast<std::uint32_t>(program_.edges.size());
}

void Decoder::jump_to(std::uint32_t label, BlockEnd end) {
  end_block(end, kNoSlot);
  program_.edges.push_back({label, static_cast<std::uint32_t>(program_.code.size()), 0, 0});
  program_.blocks.back().edges = 1;
}

/// Edges name labels until every block has its number.
void Decoder::resolve_labels() {
  for (Edge& edge : program_.edges) {
    edge.target = label_block_[edge.target];
    QUADRILLE_CHECK(edge.target != kNoNumber, "an edge to a block that was never placed");
  }
}

void Decoder::inline_function(Frame& frame) {
  if (frame.depth > kMaxCallDepth)
    throw user_error("shader '{}': calls nest deeper than {}", module_.name, kMaxCallDepth);
  const std::vector<std::size_t> order = structured_order(*frame.function);
  prepare_labels(frame, order);
  find_kill_merges(frame, order);
  jump_to(frame.labels.at(frame.function->blocks[order.front()].label), BlockEnd::kJump);
  for (const std::size_t index : order) {
    const SpirvBlock& block = frame.function->blocks[index];
    begin_block(frame.labels.at(block.label));
    for (const SpirvInstruction& in : block.body) {
      instruction(frame, in);
      if (program_.code.size() > kMaxCode)
        throw user_error("shader '{}': more than {} operations after inlining", module_.name, kMaxCode);
    }
    terminate(frame, block);
  }
}

/// Labels, and cells for phi results: an edge may write a phi before its block is decoded.
void Decoder::prepare_labels(Frame& frame, std::span<const std::size_t> order) {
  for (const std::size_t index : order) {
    const SpirvBlock& block = frame.function->blocks[index];
    frame.labels[block.label] = new_label();
    for (const SpirvInstruction& phi : block.phis) static_cast<void>(define(frame, phi));
    for (const SpirvInstruction& in : block.body) frame.definitions[in.result] = &in;
  }
}

/// A discarded lane goes on as a helper behind the innermost construct it is in, where the lanes it left are
/// going too.
void Decoder::find_kill_merges(Frame& frame, std::span<const std::size_t> order) {
  std::vector<std::pair<std::size_t, Id>> open;  // merge's place in the order, its label
  std::unordered_map<Id, std::size_t> place;
  for (std::size_t i = 0; i < order.size(); ++i) place[frame.function->blocks[order[i]].label] = i;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const SpirvBlock& block = frame.function->blocks[order[i]];
    while (!open.empty() && open.back().first <= i) open.pop_back();
    if (is_kill(block.terminator.op) && !open.empty()) frame.kill_merge[block.label] = open.back().second;
    if (place.contains(block.merge)) open.emplace_back(place.at(block.merge), block.merge);
  }
}

void Decoder::call(Frame& frame, const SpirvInstruction& in) {
  Frame callee;
  callee.function = &module_.functions.at(in.words[0]);
  callee.caller = &frame;
  callee.depth = frame.depth + 1;
  for (std::size_t i = 0; i < callee.function->parameters.size(); ++i)
    callee.values[callee.function->parameters[i]] = value(frame, in.words[i + 1]);
  if (module_.type(in.type).kind != TypeKind::kVoid) callee.return_slot = define(frame, in).slot;
  callee.return_label = new_label();
  inline_function(callee);
  begin_block(callee.return_label);
}

void Decoder::terminate(Frame& frame, const SpirvBlock& block) {
  const SpirvInstruction& end = block.terminator;
  switch (end.op) {
    case spv::OpBranch:
    case spv::OpBranchConditional: return branch(frame, block);
    case spv::OpSwitch: return switch_block(frame, block);
    case spv::OpReturnValue: {
      const Value& result = value(frame, end.words[0]);
      copy(frame.return_slot, result.slot, cells(result.type));
      return jump_to(frame.return_label, BlockEnd::kJump);
    }
    case spv::OpKill:
    case spv::OpTerminateInvocation: {
      program_.discards = true;
      const auto merge = frame.kill_merge.find(block.label);
      return jump_to(merge == frame.kill_merge.end() ? frame.return_label : frame.labels.at(merge->second),
                     BlockEnd::kKill);
    }
    default: return jump_to(frame.return_label, BlockEnd::kJump);  // OpReturn; OpUnreachable cannot run
  }
}

void Decoder::branch(Frame& frame, const SpirvBlock& block) {
  const SpirvInstruction& end = block.terminator;
  if (end.op == spv::OpBranch) {
    end_block(BlockEnd::kJump, kNoSlot);
    return add_edge(frame, block.label, end.words[0], 0);
  }
  record_discard_margin(frame, end);
  end_block(BlockEnd::kBranch, value(frame, end.words[0]).slot);
  add_edge(frame, block.label, end.words[1], 0);
  add_edge(frame, block.label, end.words[2], 0);
}

void Decoder::switch_block(Frame& frame, const SpirvBlock& block) {
  const std::vector<std::uint32_t>& words = block.terminator.words;
  end_block(BlockEnd::kSwitch, value(frame, words[0]).slot);
  add_edge(frame, block.label, words[1], 0);
  for (std::size_t i = 2; i + 1 < words.size(); i += 2) add_edge(frame, block.label, words[i + 1], words[i]);
}

void Decoder::add_edge(Frame& frame, Id from, Id to, std::uint32_t literal) {
  const auto first = static_cast<std::uint32_t>(program_.code.size());
  phi_moves(frame, from, to);
  program_.edges.push_back(
      {frame.labels.at(to), first, static_cast<std::uint32_t>(program_.code.size()) - first, literal});
  ++program_.blocks.back().edges;
}

/// Phis of a block read their sources at once; where one reads what another writes, all go through fresh
/// cells.
void Decoder::phi_moves(Frame& frame, Id from, Id to) {
  struct Move {
    Slot dst, src;
    std::uint32_t n;
  };
  std::vector<Move> moves;
  for (const SpirvBlock& block : frame.function->blocks) {
    if (block.label != to) continue;
    for (const SpirvInstruction& phi : block.phis) {
      for (std::size_t i = 0; i + 1 < phi.words.size(); i += 2) {
        if (phi.words[i + 1] != from) continue;
        const Value& target = value(frame, phi.result);
        if (target.kind != Value::Kind::kCells) unsupported("a phi of pointers");
        moves.push_back({target.slot, value(frame, phi.words[i]).slot, cells(target.type)});
      }
    }
  }
  bool conflict = false;
  for (const Move& a : moves) {
    for (const Move& b : moves)
      conflict = conflict || (&a != &b && (overlaps(a.dst, b.src, a.n) || overlaps(a.dst, b.src, b.n)));
  }
  if (conflict) {
    for (Move& move : moves) {
      const Slot staged = allocate(move.n);
      copy(staged, move.src, move.n);
      move.src = staged;
    }
  }
  for (const Move& move : moves) copy(move.dst, move.src, move.n);
}

void Decoder::record_discard_margin(Frame& frame, const SpirvInstruction& terminator) {
  for (const SpirvBlock& block : frame.function->blocks) {
    if ((block.label == terminator.words[1] || block.label == terminator.words[2]) &&
        is_kill(block.terminator.op)) {
      return margin_of(frame, terminator.words[0]);
    }
  }
}

/// Follows the condition through logical operations down to the float comparisons it is made of.
void Decoder::margin_of(Frame& frame, Id condition) {
  std::vector<Id> open{condition};
  std::set<Id> seen;
  while (!open.empty()) {
    const Id id = open.back();
    open.pop_back();
    const auto found = frame.definitions.find(id);
    if (found == frame.definitions.end() || !seen.insert(id).second) continue;
    const SpirvInstruction& in = *found->second;
    if (in.op == spv::OpLogicalNot || in.op == spv::OpLogicalAnd || in.op == spv::OpLogicalOr) {
      open.insert(open.end(), in.words.begin(), in.words.end());
    } else if (in.op >= spv::OpFOrdLessThan && in.op <= spv::OpFUnordGreaterThanEqual) {
      emit(note_margin, 1, kNoSlot, {value(frame, in.words[0]).slot, value(frame, in.words[1]).slot});
    }
  }
}

}  // namespace quadrille::models::reference
