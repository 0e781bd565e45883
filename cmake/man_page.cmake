# Run as a script (-P): writes the man page from the program's own help, so that it tells what the program does.
# PROGRAM, OUTPUT, VERSION, LIBRARY: folder of shared libraries that the program may need
function(help_of result)
  execute_process(COMMAND ${PROGRAM} ${ARGN} --help OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  # what roff would take for its own
  string(REPLACE "\\" "\\e" text "${text}")
  string(REPLACE "-" "\\-" text "${text}")
  string(REGEX REPLACE "\n([.'])" "\n\\\\&\\1" text "${text}")
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE overview COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE ".*Subcommands:" "" commands "${overview}")
string(REGEX MATCHALL "\n  [a-z]+ " commands "${commands}")
help_of(text)
set(page ".TH SUMO\\-GAMMA 1 \"\" \"sumo\\-gamma ${VERSION}\" \"User Commands\"
.SH NAME
sumo\\-gamma \\- mixed urban traffic by the GAMMA motion model for Eclipse SUMO
.SH SYNOPSIS
.B sumo\\-gamma
.I COMMAND
[options]
.SH DESCRIPTION
.nf
${text}.fi
.SH COMMANDS
")
foreach(command IN LISTS commands)
  string(STRIP "${command}" command)
  help_of(text ${command})
  string(APPEND page ".SS ${command}\n.nf\n${text}.fi\n")
endforeach()
string(APPEND page ".SH EXIT STATUS
0 done; 1 ran, but something that it was asked to guarantee did not hold; 2 bad input or usage; 3 SUMO failed, outputs
so far are complete; 130 interrupted, likewise.
.SH SEE ALSO
.BR sumo (1),
.BR netconvert (1)
")
file(WRITE ${OUTPUT} "${page}")
