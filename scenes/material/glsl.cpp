#include "scenes/material/glsl.h"

#include "models/base/error.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <cctype>
#include <mutex>

namespace quadrille::scenes {
namespace {

/// glslang is initialised on first use and finalised with the process.
void initialise_once() {
  struct Process {
    Process() { glslang::InitializeProcess(); }
    ~Process() { glslang::FinalizeProcess(); }
  };
  static const Process process;
}

/// glslang's parser is not promised to be safe for several threads.
std::mutex& compiler_lock() {
  static std::mutex lock;
  return lock;
}

/// The first error of a log, "ERROR: name:line: text", as "name:line: text".
std::string first_error(const char* log, std::string_view name) {
  std::string_view text = log;
  const std::string_view mark = "ERROR: ";
  if (const auto at = text.find(mark); at != std::string_view::npos) text.remove_prefix(at + mark.size());
  text = text.substr(0, text.find('\n'));
  if (text.substr(0, name.size()) == name && !text.empty()) return std::string(text);
  return std::string(name) + ": " +
         std::string(text.empty() ? std::string_view("glslang refuses it without a reason") : text);
}

std::string preamble_of(std::span<const std::string> defines) {
  std::string preamble;
  for (const std::string& define : defines) preamble += "#define " + define + "\n";
  return preamble;
}

}  // namespace

std::vector<std::uint32_t> compile_glsl(std::string_view source, traces::ShaderStage stage,
                                        std::string_view name, std::span<const std::string> defines) {
  for (const std::string& define : defines)
    if (define.empty() || define.find('\n') != std::string::npos)
      throw user_error("{}: a define is one line \"NAME\" or \"NAME VALUE\"", name);
  const std::scoped_lock lock(compiler_lock());
  initialise_once();
  const EShLanguage language = stage == traces::ShaderStage::kVertex ? EShLangVertex : EShLangFragment;
  glslang::TShader shader(language);
  const std::string file(name), preamble = preamble_of(defines);
  const char* text = source.data();
  const char* file_name = file.c_str();
  const int length = static_cast<int>(source.size());
  shader.setStringsWithLengthsAndNames(&text, &length, &file_name, 1);
  shader.setPreamble(preamble.c_str());
  shader.setEntryPoint("main");
  shader.setEnvInput(glslang::EShSourceGlsl, language, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
  const auto messages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
  if (!shader.parse(GetDefaultResources(), 450, false, messages))
    throw user_error("{}", first_error(shader.getInfoLog(), name));
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(messages)) throw user_error("{}", first_error(program.getInfoLog(), name));
  glslang::SpvOptions options;
  options.generateDebugInfo = true;
  options.disableOptimizer = true;
  std::vector<std::uint32_t> words;
  glslang::GlslangToSpv(*program.getIntermediate(language), words, &options);
  return words;
}

}  // namespace quadrille::scenes
