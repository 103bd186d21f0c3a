# piperun_embed(TARGET FUNCTION GLOB): text files as string literals of the target, behind
# `const std::vector<EmbeddedFile>& piperun::scenarios::FUNCTION()`.
function(piperun_embed target function pattern)
  file(GLOB files CONFIGURE_DEPENDS ${pattern})
  list(SORT files)
  set(entries "")
  foreach(file IN LISTS files)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    get_filename_component(name ${file} NAME_WLE)
    file(READ ${file} text)
    string(APPEND entries "    {\"${name}\", R\"piperun_text(${text})piperun_text\"},\n")
  endforeach()
  set(output ${CMAKE_CURRENT_BINARY_DIR}/${function}.cc)
  file(GENERATE OUTPUT ${output} CONTENT "#include \"scenarios/embedded.h\"
namespace piperun::scenarios {
const std::vector<EmbeddedFile>& ${function}() {
  static const std::vector<EmbeddedFile> files{
${entries}  };
  return files;
}
}  // namespace piperun::scenarios
")
  target_sources(${target} PRIVATE ${output})
endfunction()
