"""What an operator reads, from the top line down, and on a single line."""

from zteleop.control.hold import HOLDS, PAUSE
from zteleop.screen.bars import bar_lines
from zteleop.screen.dashboard import WIDE, Dashboard, Line, labelled, line
from zteleop.screen.heading import heading, state
from zteleop.screen.values import asked_text, out_text, output_line, speeds_line, twist_text, value_lines
from zteleop.terminal.cells import Span, printable, wrap


def readings(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return the lines from the top, best first."""
    if d.keys:
        return [*heading(d, columns, unicode), line(9), *help_lines(d, columns)]
    own = [output_line(d)] if d.drive == "step" and columns >= WIDE else []
    own += [speeds_line(d, columns)] if d.drive == "hold" else []
    return [
        *heading(d, columns, unicode),
        *task_lines(d, columns),
        *own,
        line(9),
        *bar_lines(d, columns, unicode),
        idle(d, columns),
        *device_lines(d, columns),
        *link_lines(d, columns),
        line(9),
        *value_lines(d, columns, unicode),
    ]


def task_lines(d: Dashboard, columns: int) -> list[Line]:
    """Return what there is to do, in whole words: what is asked for stands out, what helps does not."""
    if not d.task.lines:
        return []
    words = [
        line(1, text, "bold" if name else "dim")
        for name, said in d.task.lines
        for text in wrap(f"{name}: {said}" if name else said, columns)
    ]
    return [*words, line(9)]


def device_lines(d: Dashboard, columns: int) -> list[Line]:
    """Return what there is to say of the device, in whole words."""
    room = max(columns - len(labelled(8, "", "", columns).spans[0].text), 1)
    return [
        labelled(8, "" if row else name, text, columns, "dim")
        for name, words in d.about
        for row, text in enumerate(wrap(words, room))
    ]


def link_lines(d: Dashboard, columns: int) -> list[Line]:
    """Return how old this operator's commands are when the robot hears them."""
    status = d.seen.status
    if status is None or not d.obeyed or not status.latency:
        return []
    words = f"commands arrive within {1000 * status.latency:.0f} ms"
    return [labelled(8, "link", words, columns, "yellow" if status.slowed else "dim")]


def help_lines(d: Dashboard, columns: int) -> list[Line]:
    """Return what each key does."""
    room = max(len(keys) for keys, _ in d.keys) + 3 if columns >= 40 else 0
    if not room:
        return [Line(3, [Span(keys, "bold"), Span(f" {does}")]) for keys, does in d.keys]
    return [Line(3, [Span(keys.ljust(room), "bold"), Span(does)]) for keys, does in d.keys]


def brief(d: Dashboard, unicode: bool) -> list[Span]:
    """Return all that matters on a single line."""
    note = Span("  " + printable(d.seen.note, unicode), "alarm" if d.seen.alarm else "dim")
    if d.seen.alarm:
        return [*state(d, unicode), note]
    applied = d.seen.status.applied if d.seen.status else None
    out = out_text(d, 20, unicode) if d.drive == "step" else twist_text(applied, 20)
    in_vain = [Span(f"  asked {asked_text(d, 20)}, not obeyed", "dim")] if d.asks and not d.obeyed else []
    return [*state(d, unicode), Span(f"  {out}"), *in_vain, note]


def idle(d: Dashboard, columns: int) -> Line:
    """Return how long the robot goes on without a key."""
    if d.status is None:
        return labelled(7, "idle", "nobody hears what is asked", columns, "dim")
    if d.idle_left is None:
        return labelled(7, "idle", "you ask for nothing", columns, "dim")
    if d.status.state == PAUSE:
        return labelled(7, "idle", "at rest: the link was lost", columns, "dim")
    if d.status.state in HOLDS:
        return labelled(7, "idle", f"at rest: it is {d.status.state}", columns, "dim")
    if d.asks and d.seen.refused and not d.obeyed:
        return labelled(7, "idle", "not yours to end: you are not obeyed", columns, "dim")
    words = f"neutral in {d.idle_left:.1f} s" if columns >= 28 else f"{d.idle_left:.1f} s left"
    return labelled(5, "idle", words, columns, "yellow" if d.idle_left < 2 else "")
