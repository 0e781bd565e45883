# sumogamma_embed(MODULE FILE SYMBOL ...): each file of src/MODULE becomes a std::string_view of that name, so that the
# program needs no data files at run time. Run as a script (-P) it writes one such source file.
if(CMAKE_SCRIPT_MODE_FILE)
  file(READ ${INPUT} content)
  file(WRITE ${OUTPUT} "#include <string_view>\n\nnamespace sumogamma {\n"
    "extern const std::string_view ${SYMBOL};\n"
    "const std::string_view ${SYMBOL} = R\"embedded(${content})embedded\";\n}\n")
  return()
endif()

function(sumogamma_embed module)
  while(ARGN)
    list(POP_FRONT ARGN file symbol)
    set(input ${PROJECT_SOURCE_DIR}/src/${module}/${file})
    set(output ${PROJECT_BINARY_DIR}/embedded/${module}/${file}.cpp)
    add_custom_command(OUTPUT ${output}
      COMMAND ${CMAKE_COMMAND} -DINPUT=${input} -DOUTPUT=${output} -DSYMBOL=${symbol}
              -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
      DEPENDS ${input} ${PROJECT_SOURCE_DIR}/cmake/embed.cmake)
    target_sources(sumogamma_${module} PRIVATE ${output})
  endwhile()
endfunction()
