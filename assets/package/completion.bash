# Completion of palpate for bash: verbs, options and values are what its own --help and lists name.
_palpate() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    words=$(palpate --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/ s/^  \([a-z]*\) .*/\1/p')
    COMPREPLY=($(compgen -W "$words --help --version" -- "$word"))
  elif [ "$before" = --method ]; then
    COMPREPLY=($(compgen -W "$(palpate fit --list-methods 2>/dev/null)" -- "$word"))
  elif [ "$before" = --scene ]; then
    COMPREPLY=($(compgen -W "$(palpate scenes 2>/dev/null | sed '1d; s/ .*//')" -- "$word"))
  elif [ "$before" = --material ]; then
    COMPREPLY=($(compgen -W "$(palpate synth --list 2>/dev/null | sed 's/ .*//')" -- "$word"))
  elif [ "$before" = --kernel ]; then
    words=$(palpate fit --help 2>/dev/null | sed -n 's/.*--kernel \([a-z|-]*\).*/\1/p')
    COMPREPLY=($(compgen -W "${words//|/ }" -- "$word"))
  elif [ "$COMP_CWORD" -eq 2 ] && [ "$before" = study ] && [[ $word != -* ]]; then
    words=$(palpate study --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/ s/^  \([a-z]*\) .*/\1/p')
    COMPREPLY=($(compgen -W "$words" -- "$word"))
  elif [[ $word == -* ]]; then
    [ "${COMP_WORDS[1]}" = study ] && words=${COMP_WORDS[2]} || words=
    words=$(palpate "${COMP_WORDS[1]}" ${words##-*} --help 2>/dev/null | grep -o -- '--[a-z][a-z-]*' | sort -u)
    COMPREPLY=($(compgen -W "$words" -- "$word"))
  else
    COMPREPLY=($(compgen -f -- "$word"))
  fi
}
complete -o filenames -F _palpate palpate
