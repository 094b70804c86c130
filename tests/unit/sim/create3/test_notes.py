from zteleop.messages import AudioNote, AudioNoteVector, Duration, Header, Time
from zteleop.sim.create3.notes import MOST, Notes, runtime

HALF = Duration(0, 500_000_000)


def song(*frequencies: int, append: bool = False, runtime: Duration = HALF) -> AudioNoteVector:
    played = [AudioNote(frequency, runtime) for frequency in frequencies]
    return AudioNoteVector(Header(Time(0, 0), ""), played, append)


def begun(notes: Notes) -> list[int]:
    found = [note.frequency for note in notes.started]
    notes.started.clear()
    return found


def test_notes_are_played_one_after_the_other_for_as_long_as_each_lasts() -> None:
    notes = Notes()
    notes.hear(song(440, 880))
    seen = []
    for _ in range(9):
        notes.step(0.125)
        seen.append(notes.playing.frequency if notes.playing else 0)
    assert seen == [440] * 4 + [880] * 4 + [0]
    assert begun(notes) == [440, 880]


def test_new_notes_come_instead_or_after() -> None:
    notes = Notes()
    notes.hear(song(440, 450))
    notes.step(0.1)
    notes.hear(song(880, append=True))
    notes.step(0.1)
    assert begun(notes) == [440]
    notes.hear(song(220))
    notes.step(0.1)
    assert begun(notes) == [220]
    notes.step(10.0)
    assert begun(notes) == []


def test_notes_without_a_length_end_at_once_and_a_silence_costs_nothing() -> None:
    notes = Notes()
    notes.step(100.0)
    notes.hear(song(440, 880, runtime=Duration(-3, 0)))
    notes.step(0.01)
    assert begun(notes) == [440, 880]
    assert notes.playing is None
    notes.hear(song(220))
    notes.step(0.4)
    assert notes.playing == AudioNote(220, HALF)
    assert runtime(notes.playing) == 0.5


def test_a_flood_of_notes_is_bounded() -> None:
    notes = Notes()
    for _ in range(3):
        notes.hear(song(*[440] * MOST, append=True))
    notes.step(0.01)
    notes.step(0.5 * MOST - 0.01)
    assert notes.playing
    notes.step(0.01)
    assert notes.playing is None
