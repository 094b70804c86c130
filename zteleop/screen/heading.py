"""Who drives which robot, whether it obeys, and if not, why: the first lines an operator reads."""

from zteleop.control.hold import HOLDS
from zteleop.control.proof import called
from zteleop.control.stop import RELEASE
from zteleop.screen.dashboard import WIDE, Dashboard, Line, channel, line
from zteleop.terminal.cells import Span, cut, pad, printable, width, wrap

COLORS = {"driving": "green", "stopped": "alarm", "fault": "alarm"}


def heading(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return state and reasons; on a wide screen three lines, whatever they say."""
    robot = [Span(printable(d.robot, unicode), "bold"), Span(f"  {d.drive} drive", "dim")]
    word, who = state(d, unicode), operator(d, unicode)
    texts = [(text, style) for words, style in reasons(d, unicode) for text in wrap(words, columns)]
    if columns < WIDE:
        rows = [Line(0, bar(word, columns)), Line(7, robot), *([line(5, who)] if who else [])]
        rows += [line(2 + i, text, style) for i, (text, style) in enumerate(texts[:5])]
        return rows + slowed(d, columns, unicode)
    word += [Span(f", {who}")] if who else []
    gap = columns - sum(width(span.text) for span in robot + word)
    said = [line(2 + i if text else 9, text, style) for i, (text, style) in enumerate(texts)]
    top = [*robot, Span(" " * gap), *word] if gap > 0 else word
    return [Line(0, bar(top, columns)), *[*said, *slowed(d, columns, unicode), line(9), line(9)][:2]]


def bar(spans: list[Span], columns: int) -> list[Span]:
    """Return a line that an alarm in it colours from side to side."""
    if all(span.style != "alarm" for span in spans):
        return spans
    return [Span("".join(span.text for span in pad(spans, columns)), "alarm")]


def state(d: Dashboard, unicode: bool) -> list[Span]:
    """Return what the robot does, in a word."""
    word: str = d.seen.status.state if d.seen.status else "looking" if d.looking else "no actuator"
    if d.seen.unmanned:
        word = d.seen.unmanned.word
    elif d.seen.silence:
        word = f"no word for {d.seen.silence:.1f} s"
    return [Span(f"{'●' if unicode else '*'} {word}", COLORS.get(word, "yellow"))]


def operator(d: Dashboard, unicode: bool) -> str:
    """Return who operates, by the name that every verb calls it."""
    if d.seen.status is None or d.seen.silence:
        return ""
    if not d.seen.status.operator:
        return "nobody operates"
    sender = printable(called(d.seen.status.source, d.seen.status.operator), unicode)
    return f"you operate as {sender}" if d.seen.ours else f"{sender} operates"


def reasons(d: Dashboard, unicode: bool) -> list[tuple[str, str]]:
    """Return why the robot does what it does, and why not what is asked; each with its style."""
    status = d.seen.status
    robot = printable(d.robot, unicode)
    if status is None and d.looking:
        return [(f"listening for robot {robot}", "")]
    if d.seen.unmanned:
        return [(printable(d.seen.unmanned.why, unicode), "")]
    if status is None:
        if d.task.ends:
            return [(f"robot {robot} is gone", "")]
        others = f" ({printable(d.others, unicode)})" if d.others else ""
        start = f"start `zteleop actuator --robot {robot}`"
        if d.others and d.others.startswith("heard here"):
            start = f"q, and --robot NAME drives one of those; or {start}"
        return [(f"no actuator heard on robot {robot}{others}; {start}, or, if it moves, cut its power", "")]
    if d.seen.silence:
        was = f"{robot} has said nothing for {d.seen.silence:.1f} s; the last was: {status.state}"
        return [(f"{was}, {printable(status.why, unicode)}", "yellow")]
    # The robot's words are for every reader; here a key does it.
    why = (printable(status.why.replace(RELEASE, "r releases it"), unicode), "")
    if d.asks and d.seen.refused and not d.obeyed:
        words = in_keys(d, d.seen.refused.removesuffix(f" ({status.why})"))
        refused = (f"you are not obeyed: {printable(words, unicode)}", "yellow")
        return [why, refused] if status.state in HOLDS else [refused]
    if d.in_vain:
        return [why, (printable(d.in_vain, unicode), "yellow")]
    return [why, *dead_zone(d)]


def in_keys(d: Dashboard, words: str) -> str:
    """Return the robot's words with the key that lets go: in steps nothing is held."""
    key = d.bound.get("neutral") if d.drive == "step" else None
    return words.replace("let go", f"press {key} for neutral") if key else words


def dead_zone(d: Dashboard) -> list[tuple[str, str]]:
    """Return, while that is so, that the throttle is on but turns no motor."""
    throttle = channel(d.seen.vehicle, "throttle")
    ticks = next((pulse.duty_ticks for pulse in d.pulses if pulse.name == "throttle"), None)
    if not d.obeyed or throttle is None or ticks is None or not throttle.is_dead(ticks):
        return []
    least, most = throttle.neutral_ticks - throttle.dead_ticks, throttle.neutral_ticks + throttle.dead_ticks
    limited = d.seen.status.slowed if d.seen.status else ""
    rest = f", as {limited}" if limited else ": it does not turn yet"
    words = printable(f"throttle {ticks} is in the motor's dead zone, {least} to {most}{rest}", True)
    return [(words, "yellow")]


def slowed(d: Dashboard, columns: int, unicode: bool) -> list[Line]:
    """Return why the robot may not go as fast as it can, in a line, while that is so."""
    if d.seen.status is None or not d.seen.status.slowed:
        return []
    words = f"at most {d.seen.status.max_speed:.2f} m/s: {printable(d.seen.status.slowed, unicode)}"
    return [line(7, cut(words, columns), "yellow")]
