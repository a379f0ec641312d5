# cmake -DPROGRAM=... -DPAGE=... -DVERSION=... -DGZIP=... -P manual_page.cmake: a manual
# page of what the program says with --help, of each of its verbs too.
get_filename_component(name ${PROGRAM} NAME)

function(help_of verb out)
  execute_process(COMMAND ${PROGRAM} ${verb} --help OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "\\" "\\e" text "${text}")
  string(REPLACE "-" "\\-" text "${text}")
  # A line may not begin as a command of the page.
  string(REGEX REPLACE "\n([.'])" "\n\\\\&\\1" text "\n${text}")
  set(${out} ".nf\n${text}.fi\n" PARENT_SCOPE)
endfunction()

string(TOUPPER ${name} title)
help_of("" general)
string(REGEX REPLACE "^.nf\n\n([^\n]*)\n.*" "\\1" first "${general}")
string(REGEX REPLACE "^[^:]*: *" "" first "${first}")
set(page ".TH ${title} 1 \"\" \"palpate ${VERSION}\"\n.SH NAME\n${name} \\- ${first}\n.SH SYNOPSIS\n${general}")
# The verbs, as the general help lists them below its last heading.
execute_process(COMMAND ${PROGRAM} --help OUTPUT_VARIABLE help COMMAND_ERROR_IS_FATAL ANY)
if(help MATCHES "\nSubcommands:\n(.*)")
  string(REGEX MATCHALL "\n  [a-z]+ " verbs "\n${CMAKE_MATCH_1}")
  foreach(verb ${verbs})
    string(STRIP "${verb}" verb)
    help_of(${verb} text)
    string(TOUPPER "${name} ${verb}" heading)
    string(APPEND page ".SH ${heading}\n${text}")
  endforeach()
endif()
string(APPEND page ".SH EXIT STATUS\n0: done. 1: it could not be done, and one line on standard error that begins with \"error:\" \
says what and what to do. 2: wrong usage. 130, 143: stopped by Ctrl\\-C or SIGTERM.\n")
file(WRITE ${PAGE} "${page}")
execute_process(COMMAND ${GZIP} -9nf ${PAGE} COMMAND_ERROR_IS_FATAL ANY)
