# completion.zsh FILE LINE...: what zsh proposes at the end of each line with this file of completions
# for hamgen, a word in a line; after the words of each line one that has a dot only.
# A shell at a terminal of its own completes; instead of showing its proposals it says them between
# two marks.
zmodload zsh/zpty
folder=$(mktemp -d)
cp $1 $folder/_hamgen
cat >$folder/say <<'END'
PROMPT=
fpath=(${0:h} $fpath)
autoload -Uz compinit
compinit -u -D
zstyle ':completion:*' verbose false
typeset -a proposals
compadd() {
  if [[ ${@[1,(i)(-|--)]} != *-(O|A|D)\ * ]]; then
    local -a some
    builtin compadd -O some "$@"
    proposals+=($some)
  fi
  builtin compadd "$@"
}
say() {
  print -n $'\x02'${(F)proposals}$'\x03'
  proposals=()
  comppostfuncs=(say)
}
comppostfuncs=(say)
END
{
  TERM=dumb zpty shell zsh -f -i
  zpty -w shell "source $folder/say"
  for line in "${@:2}"; do
    zpty -w -n shell "$line"$'\t'
    zpty -r -m shell said $'*\x02*\x03*' || break
    said=${${said##*$'\x02'}%%$'\x03'*}
    [[ -z $said ]] || print -r -- ${said//$'\r'/}
    print .
    zpty -w -n shell $'\x15'  # a fresh line
  done
} always {
  zpty -d shell
  rm -r $folder
}
