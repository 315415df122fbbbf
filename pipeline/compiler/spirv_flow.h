/// The control flow of every function of a module as it was given: for what has to be known before the
/// optimiser has made one function of it.
#pragma once

#include "pipeline/compiler/spirv_words.h"

#include <cstdint>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace quadrille::pipeline {

/// Blocks are named by their labels. A branch on a constant leads only where the constant says.
class SpirvFlow {
 public:
  using Id = std::uint32_t;

  struct Block {
    std::vector<Id> successors, predecessors, calls;
    bool ends = false;   ///< the function, or the invocation
    bool kills = false;  ///< may end the invocation, itself or through a call
    bool loop = false;   ///< a loop's header
    Id merge = 0, continue_target = 0;
    std::uint32_t line = 0;  ///< of the source where the loop begins, 0: unknown
  };
  struct Function {
    Id entry = 0;  ///< label of its first block; 0: its body is elsewhere
    std::unordered_map<Id, Block> blocks;
  };

  explicit SpirvFlow(std::span<const std::uint32_t> words);

  /// The blocks that edges lead to from `from`, along them or against them, `from` among them. Nothing is
  /// followed beyond `walls`.
  [[nodiscard]] static std::unordered_set<Id> reached(const Function& function, std::vector<Id> from,
                                                      std::vector<Id> Block::*edges,
                                                      const std::unordered_set<Id>& walls = {});

  std::vector<Id> entry_points;
  std::unordered_map<Id, Function> functions;

 private:
  bool spread_kills();
  void add(std::size_t at, std::size_t count);
  void open_block(Id label);
  void add_to_block(const std::uint32_t* operands, std::size_t at, std::size_t count);

  std::span<const std::uint32_t> words_;
  std::unordered_map<Id, bool> constants_;
  Function* function_ = nullptr;
  Block* block_ = nullptr;
  std::uint32_t line_ = 0;
};

}  // namespace quadrille::pipeline
