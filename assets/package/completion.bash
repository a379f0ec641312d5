# Completion of palpate for bash: verbs and options are what its own --help lists.
_palpate() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    words=$(palpate --help 2>/dev/null | sed -n '/^Subcommands:/,$ s/^  \([a-z]*\) .*/\1/p')
    COMPREPLY=($(compgen -W "$words --help --version" -- "$word"))
  elif [ "$before" = --method ]; then
    COMPREPLY=($(compgen -W "$(palpate fit --list-methods 2>/dev/null)" -- "$word"))
  elif [[ $word == -* ]]; then
    words=$(palpate "${COMP_WORDS[1]}" --help 2>/dev/null | grep -o -- '--[a-z][a-z-]*' | sort -u)
    COMPREPLY=($(compgen -W "$words" -- "$word"))
  else
    COMPREPLY=($(compgen -f -- "$word"))
  fi
}
complete -o filenames -F _palpate palpate
