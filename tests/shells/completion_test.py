"""What shells make of a Tab, as whoever sits before them sees it: completion_test.py SHELL PROGRAM SCRIPT."""
import os
import pathlib
import pty
import re
import select
import shutil
import sys
import tempfile
import time

SHELLS = {
    "bash": ["bash", "--norc", "--noprofile", "-i"],
    "zsh": ["zsh", "-f", "-i"],
    "fish": ["fish", "--no-config", "-i"],
}
# zsh's own completion is asked for by most people's .zshrc.
BEFORE = {"bash": "", "zsh": "autoload -Uz compinit; compinit -u -D; ", "fish": ""}
LONGEST_WAIT = 20.0  # s


class Terminal:
    """A shell in a terminal of its own, in a folder."""

    def __init__(self, words, folder, environment):
        self.seen = ""
        self.process, self.file = pty.fork()
        if self.process == 0:
            os.chdir(folder)
            os.execvpe(words[0], words, environment)

    def type(self, text):
        self.seen = ""
        os.write(self.file, text.encode())

    def wait_for(self, pattern):
        """Until this is on the screen; the control sequences of colours and of the cursor do not count."""
        end = time.monotonic() + LONGEST_WAIT
        while not re.search(pattern, self.seen):
            if time.monotonic() > end:
                raise AssertionError(f"{pattern!r} did not appear, but {self.seen!r}")
            if select.select([self.file], [], [], 0.1)[0]:
                text = os.read(self.file, 4096).decode(errors="replace")
                self.seen += re.sub(r"\x1b(\[[0-9;?>=]*[A-Za-z]|\][^\x07]*\x07|[()][A-Z0-9]|[=>])", "", text)


def main(shell, program, script):
    if shutil.which(shell) is None:
        sys.exit(77)
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "my room.yaml").touch()
        program_folder = os.path.dirname(os.path.realpath(program))
        environment = {
            **os.environ,
            "PATH": f"{program_folder}:{os.environ['PATH']}",
            "HOME": folder,
            "TERM": "xterm",
        }
        terminal = Terminal(SHELLS[shell], folder, environment)
        terminal.type(f"{BEFORE[shell]}source '{os.path.realpath(script)}'; echo 'IS' 'READY'\r")
        terminal.wait_for("IS READY")
        for typed, completed in [
            ("glocal descr\t", r"glocal describe "),
            ("glocal run --thr\t", r"glocal run --threads "),
            ("glocal run --set localizer.matcher.ransam.it\t", r"ransam\.iterations=(?! )"),
            ("glocal run --set localizer.matcher=branch_a\t", r"localizer\.matcher=branch_and_bound "),
            ("glocal run my\t", r"glocal run my\\ room\.yaml "),
            ("glocal run --out=my\t", r"--out=my\\ room\.yaml"),
            ("glocal map con\t", r"glocal map convert "),
        ]:
            terminal.type(typed)
            terminal.wait_for(completed)
            terminal.type("\x15")  # Away with the line.
            time.sleep(0.1)


main(*sys.argv[1:])
