#include "models/memory/dram/request_queue.h"

namespace quadrille::models {

std::uint32_t DramQueue::add(const DramEntry& entry) {
  if (free_.empty()) {
    free_.push_back(static_cast<std::uint32_t>(nodes_.size()));
    nodes_.emplace_back();
  }
  const std::uint32_t index = free_.back();
  free_.pop_back();
  Bank& bank = banks_[entry.at.bank];
  List &age = age_[entry.write], &list = bank.list[entry.write];
  nodes_[index] = {entry, kNone, age.last, kNone, list.last};
  (age.last == kNone ? age.first : nodes_[age.last].next) = index;
  age.last = index;
  if (list.last == kNone) {
    bank.place[entry.write] = static_cast<std::uint32_t>(active_[entry.write].size());
    active_[entry.write].push_back(entry.at.bank);
  }
  (list.last == kNone ? list.first : nodes_[list.last].bank_next) = index;
  list.last = index;
  ++count_[entry.write];
  ++bank.count;
  return index;
}

void DramQueue::remove(std::uint32_t index) {
  const Node& node = nodes_[index];
  Bank& bank = banks_[node.entry.at.bank];
  List &age = age_[node.entry.write], &list = bank.list[node.entry.write];
  (node.prev == kNone ? age.first : nodes_[node.prev].next) = node.next;
  (node.next == kNone ? age.last : nodes_[node.next].prev) = node.prev;
  (node.bank_prev == kNone ? list.first : nodes_[node.bank_prev].bank_next) = node.bank_next;
  (node.bank_next == kNone ? list.last : nodes_[node.bank_next].bank_prev) = node.bank_prev;
  --count_[node.entry.write];
  --bank.count;
  if (list.first == kNone) {
    std::vector<std::uint32_t>& active = active_[node.entry.write];
    active[bank.place[node.entry.write]] = active.back();
    banks_[active.back()].place[node.entry.write] = bank.place[node.entry.write];
    active.pop_back();
  }
  free_.push_back(index);
}

std::uint32_t DramQueue::oldest() const {
  const std::uint32_t read = age_[0].first, write = age_[1].first;
  if (read == kNone || write == kNone) return read == kNone ? write : read;
  return nodes_[read].entry.seq < nodes_[write].entry.seq ? read : write;
}

std::uint32_t DramQueue::oldest_of_row(std::uint32_t bank, bool write, std::int32_t row) const {
  std::uint32_t i = banks_[bank].list[write].first;
  while (i != kNone && nodes_[i].entry.at.row != row) i = nodes_[i].bank_next;
  return i;
}

bool DramQueue::another_of_row(std::uint32_t entry) const {
  const std::int32_t row = nodes_[entry].entry.at.row;
  std::uint32_t i = nodes_[entry].bank_next;
  while (i != kNone && nodes_[i].entry.at.row != row) i = nodes_[i].bank_next;
  return i != kNone;
}

}  // namespace quadrille::models
