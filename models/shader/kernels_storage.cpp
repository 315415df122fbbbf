/// Operations on storage buffers: each acts on memory at once, lane by lane, and leaves a request that says
/// what it moved.
#include "models/base/error.h"
#include "models/shader/kernels.h"

#include <bit>

namespace quadrille::models {
namespace {

/// The words of an operand, all lanes.
LaneWords read_row(const DecodedOperand& operand, bool constant, const ExecutionContext& x) {
  LaneWords row;
  for (int g = 0; g < kWarpGroups; ++g)
    store(row.data() + g * kGroupLanes,
          constant ? splat_word(x.constants[operand.offset]) : load_words(x.regs + operand.offset + g * 32));
  return row;
}

StorageRequest& add_request(const DecodedInstruction& d, const LaneWords& offset, LaneMask active,
                            Warp& warp) {
  StorageRequest& request = warp.accesses[static_cast<std::size_t>(warp.access_count++)];
  request.offset = offset;
  request.active = active;
  request.op = d.op;
  request.binding = d.imm;
  return request;
}

/// Calls `act(lane, offset, access)` for the lanes of a mask, in their order.
template <class Act>
void for_lanes(LaneMask lanes, const LaneWords& offsets, const WarpStorage& storage, const Act& act) {
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    act(lane, offsets[lane], StorageMemory::Access{storage.invocations[lane], storage.pass});
  }
}

/// Helpers read too: neighbours take differences with what they compute.
template <bool kConstant>
void execute_load(const DecodedInstruction& d, ExecutionContext& x) {
  Warp& warp = *x.warp;
  const WarpStorage& storage = *warp.storage;
  const LaneWords offsets = read_row(d.a, kConstant, x);
  auto* const result = reinterpret_cast<std::uint32_t*>(x.regs + d.dst);
  add_request(d, offsets, warp.exec, warp);
  for_lanes(warp.exec, offsets, storage,
            [&](std::size_t lane, std::uint32_t offset, const StorageMemory::Access& access) {
              result[lane] = storage.memory->load(storage.buffers[d.imm], offset, access);
            });
}

/// Lanes that write: neither helpers nor discarded.
LaneMask writing_lanes(const Warp& warp) { return warp.exec & warp.storage->live & ~warp.killed; }

template <unsigned kConstants>
void execute_store(const DecodedInstruction& d, ExecutionContext& x) {
  Warp& warp = *x.warp;
  const WarpStorage& storage = *warp.storage;
  const LaneWords offsets = read_row(d.a, (kConstants & 1u) != 0, x),
                  values = read_row(d.b, (kConstants & 2u) != 0, x);
  const LaneMask lanes = writing_lanes(warp);
  add_request(d, offsets, lanes, warp);
  for_lanes(lanes, offsets, storage,
            [&](std::size_t lane, std::uint32_t offset, const StorageMemory::Access& access) {
              storage.memory->store(storage.buffers[d.imm], offset, values[lane], access);
            });
}

AtomicOp atomic_of(Op op) {
  static_assert(static_cast<int>(Op::kAtomicCompareExchange) - static_cast<int>(Op::kAtomicAdd) ==
                    static_cast<int>(AtomicOp::kCompareExchange),
                "both lists have one order");
  return static_cast<AtomicOp>(static_cast<int>(op) - static_cast<int>(Op::kAtomicAdd));
}

template <unsigned kConstants>
void execute_atomic(const DecodedInstruction& d, ExecutionContext& x) {
  Warp& warp = *x.warp;
  WarpStorage& storage = *warp.storage;
  const bool compares = d.op == Op::kAtomicCompareExchange;
  const LaneWords offsets = read_row(d.a, (kConstants & 1u) != 0, x),
                  values = read_row(d.b, (kConstants & 2u) != 0, x),
                  comparators = compares ? read_row(d.c, (kConstants & 4u) != 0, x) : LaneWords{};
  auto* const result = reinterpret_cast<std::uint32_t*>(x.regs + d.dst);
  const LaneMask lanes = writing_lanes(warp);
  add_request(d, offsets, lanes, warp);
  for_lanes(lanes, offsets, storage,
            [&](std::size_t lane, std::uint32_t offset, const StorageMemory::Access& access) {
              const StorageMemory::Update update{atomic_of(d.op), values[lane], comparators[lane],
                                                 storage.updates[lane]++, storage.may_repeat};
              result[lane] = storage.memory->update(storage.buffers[d.imm], offset, update, access);
            });
}

template <bool kMasked>
void execute_size(const DecodedInstruction& d, ExecutionContext& x) {
  for (int g = 0; g < kWarpGroups; ++g)
    write_group<kMasked>(x.regs + d.dst, g, splat_word(x.warp->storage->buffers[d.imm].bytes), x);
}

template <unsigned... kConstants>
Kernel store_kernel(unsigned constants, std::integer_sequence<unsigned, kConstants...>) {
  static constexpr DecodedInstruction::Execute kTable[] = {&execute_store<kConstants>...};
  return {kTable[constants], kTable[constants]};
}
template <unsigned... kConstants>
Kernel atomic_kernel(unsigned constants, std::integer_sequence<unsigned, kConstants...>) {
  static constexpr DecodedInstruction::Execute kTable[] = {&execute_atomic<kConstants>...};
  return {kTable[constants], kTable[constants]};
}

}  // namespace

Kernel storage_kernel(Op op, const KernelShape& shape) {
  if (op == Op::kLoadBuffer) {
    const auto execute = (shape.constants & 1u) != 0 ? &execute_load<true> : &execute_load<false>;
    return {execute, execute};
  }
  if (op == Op::kStoreBuffer) return store_kernel(shape.constants, std::make_integer_sequence<unsigned, 4>{});
  if (is_atomic(op)) return atomic_kernel(shape.constants, std::make_integer_sequence<unsigned, 8>{});
  if (op == Op::kBufferSize) return {&execute_size<false>, &execute_size<true>};
  return {};
}

}  // namespace quadrille::models
