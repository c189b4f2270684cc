# Completion of glocal in bash: glocal itself says what may come next.
_glocal() {
  local words value candidates=() line=${COMP_LINE:0:COMP_POINT}
  read -r -a words <<<"$line"
  if [[ $line == *[[:space:]] ]]; then words+=(""); fi
  # Bash replaces only what stands behind the last "=" or ":" of the word.
  local typed=${words[-1]}
  local kept=${typed%"${typed##*[=:]}"}
  COMPREPLY=()
  while IFS=$'\t' read -r value _; do
    if [[ $value == :files ]]; then
      compopt -o default
      return
    fi
    candidates+=("${value#"$kept"}")
  done < <("${words[0]/#\~/$HOME}" complete -- "${words[@]:1}" 2>/dev/null)
  COMPREPLY=("${candidates[@]}")
  # A path of --set goes on.
  if [[ ${#COMPREPLY[@]} -gt 0 && ${COMPREPLY[0]} == *[.=] ]]; then compopt -o nospace; fi
}
complete -F _glocal glocal
