# SPDX-License-Identifier: MIT
# Completion of WallGL's commands in bash, with what the commands themselves say with --help.

# Options ("-h,--help   Print ...") or subcommands of a command line's help, a word a line.
_wallgl_options() { "$@" --help 2>/dev/null | sed -n 's/^ \+\(-[^ ]*\) .*/\1/p' | sed 's/=.*//' | tr , '\n'; }
_wallgl_subcommands() { "$@" --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z-]*\) .*/\1/p'; }

_wallgl() {
    local cur prev words cword
    _init_completion -n : || return
    local command=("$1") word i
    for ((i = 1; i < cword; ++i)); do
        word=${words[i]}
        [[ $word != -- ]] || { _command_offset $((i + 1)); return; }  # the program that wallrun starts
        if [[ $word != -* ]] && _wallgl_subcommands "${command[@]}" | grep -qxF -- "$word"; then command+=("$word"); fi
    done
    case "$prev" in
        --config | --ready-file | --token-file) _filedir; return ;;
        --state) _filedir -d; return ;;
    esac
    if [[ $cur == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_wallgl_options "${command[@]}")" -- "$cur")
        return
    fi
    mapfile -t COMPREPLY < <(compgen -W "$(_wallgl_subcommands "${command[@]}")" -- "$cur")
    [[ ${#COMPREPLY[@]} -gt 0 ]] || _filedir
}

complete -F _wallgl walld tileserver wallagent wallrun wallctl wallview wallplay wallcalibrate
