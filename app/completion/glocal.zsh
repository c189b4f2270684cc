#compdef glocal
# Completion of glocal in zsh: glocal itself says what may come next.
_glocal() {
  local line text
  local -a ended open
  for line in "${(@f)$("${(Q)words[1]/#\~/$HOME}" complete -- "${(@Q)words[2,CURRENT-1]}" "$PREFIX" 2>/dev/null)}"; do
    if [[ $line == :files ]]; then
      [[ $PREFIX == --*=* ]] && compset -P '*='
      _files
      return
    fi
    text=${line%%$'\t'*}
    [[ -n $text ]] || continue
    line="${text//:/\\:}:${line#*$'\t'}"
    # A path of --set goes on.
    if [[ $text == *[.=] ]]; then open+=("$line"); else ended+=("$line"); fi
  done
  _describe -t values glocal ended -- open -S ''
}
if [[ $funcstack[1] == _glocal ]]; then _glocal "$@"; else compdef _glocal glocal; fi
