# Completion of fluxel for bash: commands, the options of each as its help says them, and files.

_fluxel() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command='' word help values=''
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ $word != -* ]]; then
      command=$word
      break
    fi
  done
  if [[ -z $command ]]; then
    help=$(fluxel --help 2>/dev/null)
    mapfile -t COMPREPLY < <(compgen -W "--help --version help $(sed -n '/^Subcommands:/,$s/^  \([a-z]*\) .*/\1/p' <<<"$help")" -- "$current")
    return
  fi
  help=$(fluxel "$command" --help-all 2>/dev/null)
  # An option of few words, as --method hierarchical|matrix, has these as its values.
  [[ $previous =~ ^--[a-z-]+$ ]] && values=$(sed -n "s/^  \(-[a-zA-Z],\)\{0,1\}$previous \([a-z][a-z0-9|-]*|[a-z0-9|-]*\).*/\2/p" <<<"$help" | head -n 1)
  if [[ -n $values ]]; then
    mapfile -t COMPREPLY < <(compgen -W "${values//|/ }" -- "$current")
  elif [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(grep -oE '^  (-[a-zA-Z],)?--[a-z-]+' <<<"$help" | grep -oE -- '--[a-z-]+')" -- "$current")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$current")
    compopt -o filenames
  fi
}
complete -F _fluxel fluxel
