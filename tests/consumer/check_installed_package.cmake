# Installs BUILD into a fresh prefix below WORK, builds the consumer against it with find_package, runs it, and
# sees that no private header was installed.
#   cmake -DBUILD=.. -DSOURCE=.. -DWORK=.. -DCOMPILER=.. -P check_installed_package.cmake
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${result}): ${command}")
  endif()
endfunction()

set(prefix ${WORK}/prefix)
file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
file(GLOB_RECURSE private ${prefix}/include/*/bullet/*)
if(private)
  message(FATAL_ERROR "private headers were installed: ${private}")
endif()
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/build -G Ninja -DCMAKE_PREFIX_PATH=${prefix}
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} --build ${WORK}/build)
file(GLOB programs ${WORK}/build/robot ${WORK}/build/campaign ${prefix}/bin/piperun)
foreach(program IN LISTS programs)
  if(program MATCHES "bin/piperun$")
    run(${program} --help)
  else()
    run(${program})
  endif()
endforeach()
