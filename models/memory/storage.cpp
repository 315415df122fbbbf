/// The rules for words that several invocations of a pass access.
#include "models/memory/storage.h"

#include "models/base/error.h"

#include <algorithm>

namespace quadrille::models {
namespace {

std::uint32_t updated(AtomicOp op, std::uint32_t old, const StorageMemory::Update& update) {
  const auto as_signed = [](std::uint32_t bits) { return static_cast<std::int32_t>(bits); };
  switch (op) {
    case AtomicOp::kAdd: return old + update.value;
    case AtomicOp::kIMin: return as_signed(update.value) < as_signed(old) ? update.value : old;
    case AtomicOp::kUMin: return std::min(old, update.value);
    case AtomicOp::kIMax: return as_signed(update.value) > as_signed(old) ? update.value : old;
    case AtomicOp::kUMax: return std::max(old, update.value);
    case AtomicOp::kAnd: return old & update.value;
    case AtomicOp::kOr: return old | update.value;
    case AtomicOp::kXor: return old ^ update.value;
    case AtomicOp::kExchange: return update.value;
    case AtomicOp::kCompareExchange: return old == update.comparator ? update.value : old;
  }
  return old;
}

}  // namespace

void StorageMemory::Group::add(const Invocation& who) {
  if (members == 0) {
    one = who;
    members = 1;
  } else if (one != who) {
    one = std::max(one, who);
    members = 2;
  }
}

std::uint32_t StorageMemory::watch(std::string name, std::uint64_t address, std::uint64_t bytes) {
  watched_.push_back({std::move(name), address, std::vector<Word>(static_cast<std::size_t>(bytes / 4))});
  return static_cast<std::uint32_t>(watched_.size() - 1);
}

StorageMemory::Word& StorageMemory::word(const StorageView& view, std::uint32_t offset, std::uint32_t pass) {
  Watched& buffer = watched_[view.buffer];
  Word& word = buffer.words[static_cast<std::size_t>((view.address + offset - buffer.address) / 4)];
  if (word.pass != pass) word = {pass, {}, {}, {}};
  return word;
}

void StorageMemory::race(const StorageView& view, std::uint32_t offset, const char* what) const {
  const Watched& buffer = watched_[view.buffer];
  throw user_error(
      "buffer '{}', byte {}: one invocation {} it within the pass, so its value depends on the machine's "
      "timing; do that in separate passes",
      buffer.name, view.address + offset - buffer.address, what);
}

std::uint32_t StorageMemory::load(const StorageView& view, std::uint32_t offset, const Access& access) {
  if (!inside(view, offset)) return 0;
  if (view.buffer != StorageView::kReadOnly) {
    Word& touched = word(view, offset, access.pass);
    if (touched.writers.has_other_than(access.who)) race(view, offset, "stores and another one reads");
    if (touched.updaters.has_other_than(access.who))
      race(view, offset, "updates by an atomic operation and another one reads");
    touched.readers.add(access.who);
  }
  return memory_.load<std::uint32_t>(view.address + offset);
}

void StorageMemory::store(const StorageView& view, std::uint32_t offset, std::uint32_t value,
                          const Access& access) {
  if (!inside(view, offset)) return;
  Word& touched = word(view, offset, access.pass);
  if (touched.readers.has_other_than(access.who)) race(view, offset, "stores and another one reads");
  if (touched.updaters.has_other_than(access.who))
    race(view, offset, "stores and another one updates by an atomic operation");
  const bool stays = touched.writers.members > 0 && access.who < touched.writers.one;
  touched.writers.add(access.who);
  if (!stays) memory_.store(view.address + offset, value);
}

std::uint32_t StorageMemory::update(const StorageView& view, std::uint32_t offset, const Update& update,
                                    const Access& access) {
  if (!inside(view, offset)) return 0;
  const std::pair key{access.who, update.ordinal};
  if (update.may_repeat)
    if (const auto done = returned_.find(key); done != returned_.end()) return done->second;
  Word& touched = word(view, offset, access.pass);
  if (touched.readers.has_other_than(access.who))
    race(view, offset, "updates by an atomic operation and another one reads");
  if (touched.writers.has_other_than(access.who))
    race(view, offset, "stores and another one updates by an atomic operation");
  touched.updaters.add(access.who);
  const auto old = memory_.load<std::uint32_t>(view.address + offset);
  memory_.store(view.address + offset, updated(update.op, old, update));
  if (update.may_repeat) returned_.emplace(key, old);
  return old;
}

}  // namespace quadrille::models
