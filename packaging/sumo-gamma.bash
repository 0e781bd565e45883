# bash completion for sumo-gamma: commands and options come from the program's own help
_sumo_gamma() {
  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command=${COMP_WORDS[1]}
  if [[ $COMP_CWORD == 1 && $word != -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$("${COMP_WORDS[0]}" --help 2> /dev/null |
      sed -n '/^Subcommands:/,$s/^  \([a-z]\+\) .*/\1/p')" -- "$word")
  elif [[ $word == -* ]]; then
    [[ $command == -* ]] && command=
    mapfile -t COMPREPLY < <(compgen -W "$("${COMP_WORDS[0]}" ${command:+"$command"} --help 2> /dev/null |
      grep -oE -- '--[a-z][a-z-]*' | sort -u)" -- "$word")
  else
    case $previous in
      --backend) mapfile -t COMPREPLY < <(compgen -W "traci libsumo" -- "$word") ;;
      --preset) mapfile -t COMPREPLY < <(compgen -W "compliant observed" -- "$word") ;;
      *) mapfile -t COMPREPLY < <(compgen -f -- "$word") ;;
    esac
  fi
}
complete -o filenames -F _sumo_gamma sumo-gamma
