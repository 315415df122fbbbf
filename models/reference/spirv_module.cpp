/// Reading SPIR-V words into tables. [SPIR-V 1.6 #_physical_layout_of_a_spir_v_module_and_instruction]
#include "models/reference/spirv_module.h"

#include <algorithm>
#include <spirv-tools/libspirv.hpp>
#define SPV_ENABLE_UTILITY_CODE
#include <spirv/unified1/spirv.hpp>

#include "models/base/error.h"

namespace quadrille::models::reference {
namespace {

constexpr std::uint32_t kMaxCells = 1u << 20;  // scalars in one type: bounds memory for hostile arrays
constexpr std::uint32_t kMaxIds = 1u << 18;    // the tables are by id

void validate_words(const traces::Shader& shader) {
  spvtools::SpirvTools tools(SPV_ENV_VULKAN_1_3);
  std::string first;
  tools.SetMessageConsumer(
      [&first](spv_message_level_t, const char*, const spv_position_t&, const char* text) {
        if (first.empty()) first = text;
      });
  if (!tools.Validate(shader.spirv.data(), shader.spirv.size())) {
    std::replace(first.begin(), first.end(), '\n', ' ');
    throw user_error("shader '{}': not valid SPIR-V for Vulkan: {}", shader.name, first);
  }
}

/// A literal string operand: four bytes a word, NUL-terminated.
std::string literal_string(std::span<const std::uint32_t> words) {
  std::string text;
  for (const std::uint32_t word : words) {
    for (unsigned byte = 0; byte < 4; ++byte) {
      const char c = static_cast<char>((word >> (8 * byte)) & 0xffu);
      if (c == 0) return text;
      text.push_back(c);
    }
  }
  return text;
}

bool is_terminator(std::uint32_t op) {
  switch (op) {
    case spv::OpBranch:
    case spv::OpBranchConditional:
    case spv::OpSwitch:
    case spv::OpReturn:
    case spv::OpReturnValue:
    case spv::OpKill:
    case spv::OpTerminateInvocation:
    case spv::OpUnreachable: return true;
    default: return false;
  }
}

/// Reads one module, instruction by instruction.
class Reader {
 public:
  explicit Reader(const traces::Shader& shader) : shader_(shader) { module_.name = shader.name; }

  SpirvModule read() {
    const std::vector<std::uint32_t>& words = shader_.spirv;
    if (words[3] > kMaxIds)
      throw user_error("shader '{}': its ids reach {}, the reference allows {}", shader_.name, words[3],
                       kMaxIds);
    module_.types.resize(words[3]);
    module_.decorations.resize(words[3]);
    for (std::size_t at = 5; at < words.size(); at += words[at] >> 16)
      instruction(std::span(words).subspan(at, words[at] >> 16));
    if (module_.entry == 0)
      throw user_error("shader '{}': no {} entry point \"main\"", shader_.name, stage_name());
    return std::move(module_);
  }

 private:
  [[nodiscard]] const char* stage_name() const {
    return shader_.stage == traces::ShaderStage::kVertex ? "vertex" : "fragment";
  }

  void instruction(std::span<const std::uint32_t> words) {
    SpirvInstruction in;
    in.op = words[0] & 0xffffu;
    bool has_result = false, has_type = false;
    spv::HasResultAndType(static_cast<spv::Op>(in.op), &has_result, &has_type);
    std::size_t at = 1;
    if (has_type) in.type = words[at++];
    if (has_result) in.result = words[at++];
    in.words.assign(words.begin() + static_cast<std::ptrdiff_t>(at), words.end());
    if (function_ != nullptr) {
      in_function(std::move(in));
    } else {
      at_top(std::move(in));
    }
  }

  void at_top(SpirvInstruction in) {
    switch (in.op) {
      case spv::OpExtInstImport:
        if (literal_string(in.words) == "GLSL.std.450") module_.glsl_import = in.result;
        return;
      case spv::OpEntryPoint: return entry_point(in);
      case spv::OpExecutionMode:
        module_.early_fragment_tests |= in.words[1] == spv::ExecutionModeEarlyFragmentTests;
        return;
      case spv::OpDecorate: return decorate(module_.decorations[in.words[0]], std::span(in.words).subspan(1));
      case spv::OpMemberDecorate:
        return decorate(module_.member_decorations[{in.words[0], in.words[1]}],
                        std::span(in.words).subspan(2));
      case spv::OpFunction:
        function_ = &module_.functions[in.result];
        function_->id = in.result;
        return;
      default: break;
    }
    if (in.op >= spv::OpTypeVoid && in.op <= spv::OpTypeForwardPointer) {
      type(in);
    } else if (in.type != 0 && in.result != 0) {
      if (in.op == spv::OpConstant) constants_[in.result] = in.words[0];
      module_.globals.push_back(std::move(in));
    }
  }

  void entry_point(const SpirvInstruction& in) {
    const auto wanted = shader_.stage == traces::ShaderStage::kVertex ? spv::ExecutionModelVertex
                                                                      : spv::ExecutionModelFragment;
    if (in.words[0] == static_cast<std::uint32_t>(wanted) &&
        literal_string(std::span(in.words).subspan(2)) == "main")
      module_.entry = in.words[1];
  }

  static void decorate(Decorations& d, std::span<const std::uint32_t> words) {
    const std::uint32_t value = words.size() > 1 ? words[1] : 0;
    switch (words[0]) {
      case spv::DecorationBuiltIn: d.builtin = value; break;
      case spv::DecorationLocation: d.location = value; break;
      case spv::DecorationIndex: d.index = value; break;
      case spv::DecorationComponent: d.component = value; break;
      case spv::DecorationBinding: d.binding = value; break;
      case spv::DecorationDescriptorSet: d.set = value; break;
      case spv::DecorationOffset: d.offset = value; break;
      case spv::DecorationArrayStride: d.array_stride = value; break;
      case spv::DecorationMatrixStride: d.matrix_stride = value; break;
      case spv::DecorationRowMajor: d.row_major = true; break;
      case spv::DecorationFlat: d.flat = true; break;
      case spv::DecorationNoPerspective: d.no_perspective = true; break;
      case spv::DecorationCentroid: d.centroid = true; break;
      case spv::DecorationSample: d.sample = true; break;
      default: break;  // precision hints and names change nothing here
    }
  }

  void type(const SpirvInstruction& in) {
    SpirvType t;
    const std::vector<std::uint32_t>& w = in.words;
    const auto unsupported = [&t](std::string_view what) {
      t.kind = TypeKind::kUnsupported, t.problem = what;
    };
    switch (in.op) {
      case spv::OpTypeVoid: t.kind = TypeKind::kVoid; break;
      case spv::OpTypeBool: t.kind = TypeKind::kBool, t.cells = 1; break;
      case spv::OpTypeInt:
        t.kind = TypeKind::kInt, t.is_signed = w[1] != 0, t.cells = 1;
        if (w[0] != 32) unsupported("an integer type that is not 32 bits wide");
        break;
      case spv::OpTypeFloat:
        t.kind = TypeKind::kFloat, t.cells = 1;
        if (w[0] != 32) unsupported("a float type that is not 32 bits wide");
        break;
      case spv::OpTypeVector: aggregate(t, TypeKind::kVector, w[0], w[1]); break;
      case spv::OpTypeMatrix: aggregate(t, TypeKind::kMatrix, w[0], w[1]); break;
      case spv::OpTypeArray: array(t, w[0], w[1]); break;
      case spv::OpTypeStruct: structure(t, w); break;
      case spv::OpTypePointer: t.kind = TypeKind::kPointer, t.storage = w[0], t.element = w[1]; break;
      case spv::OpTypeFunction: t.kind = TypeKind::kFunction, t.element = w[0]; break;
      case spv::OpTypeImage:
        t.kind = TypeKind::kImage;
        if ((w[1] != spv::Dim1D && w[1] != spv::Dim2D && w[1] != spv::Dim3D && w[1] != spv::DimCube) ||
            (w[4] != 0 && w[1] != spv::Dim2D) || w[5] != 1)
          unsupported(
              "an image other than a sampled one, 1D, 2D, 3D or a cube, or an array, of several samples in "
              "2D");
        break;
      case spv::OpTypeSampler: t.kind = TypeKind::kSampler; break;
      case spv::OpTypeSampledImage: t.kind = TypeKind::kSampledImage, t.element = w[0]; break;
      default:
        unsupported(
            "a type that is not void, bool, int, float, vector, matrix, sized array, struct, pointer, "
            "image, sampler or both in one");
        break;
    }
    inherit_problem(t, t.element);
    for (const Id member : t.members) inherit_problem(t, member);
    module_.types[in.result] = std::move(t);
  }

  void inherit_problem(SpirvType& t, Id part) const {
    if (part != 0 && module_.type(part).kind == TypeKind::kUnsupported)
      t.kind = TypeKind::kUnsupported, t.problem = module_.type(part).problem;
  }

  void aggregate(SpirvType& t, TypeKind kind, Id element, std::uint32_t count) {
    t.kind = kind, t.element = element, t.count = count;
    t.cells = checked_cells(std::uint64_t{module_.type(element).cells} * count);
  }
  void array(SpirvType& t, Id element, Id length) {
    const auto constant = constants_.find(length);
    if (constant == constants_.end()) {
      t.kind = TypeKind::kUnsupported, t.problem = "an array whose length is not a plain constant";
    } else {
      aggregate(t, TypeKind::kArray, element, constant->second);
    }
  }
  void structure(SpirvType& t, const std::vector<std::uint32_t>& members) {
    t.kind = TypeKind::kStruct, t.members = members;
    std::uint64_t cells = 0;
    for (const Id member : members) cells += module_.type(member).cells;
    t.cells = checked_cells(cells);
  }
  [[nodiscard]] std::uint32_t checked_cells(std::uint64_t cells) const {
    if (cells > kMaxCells)
      throw user_error("shader '{}': a type holds {} scalars, the reference allows {}", shader_.name, cells,
                       kMaxCells);
    return static_cast<std::uint32_t>(cells);
  }

  void in_function(SpirvInstruction in) {
    if (in.op == spv::OpFunctionEnd) {
      function_ = nullptr;
    } else if (in.op == spv::OpFunctionParameter) {
      function_->parameters.push_back(in.result);
    } else if (in.op == spv::OpLabel) {
      function_->blocks.emplace_back().label = in.result;
    } else if (in.op != spv::OpLine && in.op != spv::OpNoLine) {
      in_block(function_->blocks.back(), std::move(in));
    }
  }

  static void in_block(SpirvBlock& block, SpirvInstruction in) {
    if (in.op == spv::OpPhi) {
      block.phis.push_back(std::move(in));
    } else if (in.op == spv::OpSelectionMerge) {
      block.merge = in.words[0];
    } else if (in.op == spv::OpLoopMerge) {
      block.merge = in.words[0], block.loop_continue = in.words[1];
    } else if (is_terminator(in.op)) {
      block.terminator = std::move(in);
    } else {
      block.body.push_back(std::move(in));
    }
  }

  const traces::Shader& shader_;
  SpirvModule module_;
  SpirvFunction* function_ = nullptr;
  std::unordered_map<Id, std::uint32_t> constants_;  // for array lengths
};

}  // namespace

Decorations SpirvModule::member(Id struct_type, std::uint32_t index) const {
  const auto found = member_decorations.find({struct_type, index});
  return found == member_decorations.end() ? Decorations{} : found->second;
}

const SpirvType& SpirvModule::scalar_of(Id id) const {
  const SpirvType* t = &type(id);
  while (t->kind == TypeKind::kVector || t->kind == TypeKind::kMatrix) t = &type(t->element);
  return *t;
}

SpirvModule read_spirv(const traces::Shader& shader) {
  validate_words(shader);
  return Reader(shader).read();
}

}  // namespace quadrille::models::reference
