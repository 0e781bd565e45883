# sumogamma_embed(MODULE SYMBOL FILE...): the files of src/MODULE, one after the other, become a std::string_view of that
# name, so that the program needs no data files at run time. Run as a script (-P) it writes one such source file.
if(CMAKE_SCRIPT_MODE_FILE)
  string(REPLACE "|" ";" inputs "${INPUTS}")
  set(content)
  foreach(input IN LISTS inputs)
    file(READ ${input} part)
    string(APPEND content "${part}")
  endforeach()
  file(WRITE ${OUTPUT} "#include <string_view>\n\nnamespace sumogamma {\n"
    "extern const std::string_view ${SYMBOL};\n"
    "const std::string_view ${SYMBOL} = R\"embedded(${content})embedded\";\n}\n")
  return()
endif()

function(sumogamma_embed module symbol)
  list(TRANSFORM ARGN PREPEND ${PROJECT_SOURCE_DIR}/src/${module}/ OUTPUT_VARIABLE inputs)
  list(JOIN inputs "|" joined)
  set(output ${PROJECT_BINARY_DIR}/embedded/${module}/${symbol}.cpp)
  add_custom_command(OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} "-DINPUTS=${joined}" -DOUTPUT=${output} -DSYMBOL=${symbol}
            -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
    DEPENDS ${inputs} ${PROJECT_SOURCE_DIR}/cmake/embed.cmake VERBATIM)
  target_sources(sumogamma_${module} PRIVATE ${output})
endfunction()
