import argparse
import sys

from zteleop.cli._completing import candidates

EXAMPLES = (
    "zteleop completion bash",
    "zteleop completion zsh",
)
SCRIPTS = {
    "bash": """\
# Completes verbs, options, topics, types, nodes and robots. Put this line into ~/.bashrc:
#   eval "$(zteleop completion bash)"
_zteleop() {
    local IFS=$'\\n'
    COMPREPLY=($(zteleop completion bash -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null))
}
complete -o default -F _zteleop zteleop
""",
    "zsh": """\
# Completes verbs, options, topics, types, nodes and robots. Put this line into ~/.zshrc, below compinit:
#   eval "$(zteleop completion zsh)"
_zteleop() {
    local -a found
    found=("${(@f)$(zteleop completion zsh -- "${(@)words[2,CURRENT]}" 2>/dev/null)}")
    if [[ -n $found ]]; then compadd -a found; else _files; fi
}
compdef _zteleop zteleop
""",
    "fish": """\
# Completes verbs, options, topics, types, nodes and robots. Put this line into ~/.config/fish/config.fish:
#   zteleop completion fish | source
complete -c zteleop -f -a '(zteleop completion fish -- (commandline -opc)[2..] (commandline -ct) 2>/dev/null)'
""",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("shell", choices=[*SCRIPTS], help="the shell that is to complete what you type")
    parser.add_argument("words", nargs="*", help=argparse.SUPPRESS)


def run(arguments: argparse.Namespace) -> None:
    if arguments.words:
        print("\n".join(candidates(arguments.words)))
    else:
        sys.stdout.write(SCRIPTS[arguments.shell])
