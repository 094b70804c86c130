"""What a black box answers: what was said on a topic in the last minute."""

from collections.abc import Iterator

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.tap import Raw
from zteleop.messages import GetHistoryRequest, GetHistoryResponse, Said
from zteleop.recording.ring import Ring

SERVICE = "blackbox/history"
AT_ONCE = 2**18
"""bytes of messages in one answer; whoever wants more asks again for what is after them"""


def serve_history(node: Node, ring: Ring) -> None:
    """Answer what a ring holds of a topic."""

    def answer(request: GetHistoryRequest) -> GetHistoryResponse:
        since = max(clock.now() - request.seconds, request.after)
        found = [raw for raw in ring.said_on(request.topic) if raw.at >= since and not raw.deleted]
        found = found[request.had if since == request.after else 0 :]
        page = list(_page(found))
        return GetHistoryResponse(
            [Said(raw.at, raw.path, raw.encoding, raw.payload) for raw in page], len(page) < len(found)
        )

    node.service(f"/{node.robot}/{SERVICE}", GetHistoryRequest, GetHistoryResponse, answer)


def _page(found: list[Raw]) -> Iterator[Raw]:
    """Yield the first of some messages, one at least."""
    size = 0
    for raw in found:
        if size > AT_ONCE:
            return
        size += len(raw.payload) + len(raw.encoding) + len(raw.path)
        yield raw
