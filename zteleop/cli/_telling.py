"""What an input without a screen says: a line whenever it, or what the robot makes of it, is another."""

from collections.abc import Callable

from zteleop.bus.escape import printable
from zteleop.screen.view import View


def teller(about: Callable[[], str]) -> Callable[[View], None]:
    """Return what prints such lines; `about` says what the input does."""
    shown = ""

    def tell(view: View) -> None:
        nonlocal shown
        status = view.status
        does = f"{status.state}: {view.refused or status.why}" if status else "no actuator is heard"
        line = f"{about()}  ->  {does.partition(' for ')[0]}"
        if line != shown:
            shown = line
            print(printable(line), flush=True)

    return tell
