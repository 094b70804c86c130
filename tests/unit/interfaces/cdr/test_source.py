import traceback

from zteleop.interfaces.cdr.source import Source


def test_lines_become_a_function() -> None:
    source = Source("def add(x):")
    more = source.hold("more", 40)
    source.line("if x:")
    source.indent(1)
    source.line(f"x += {more}")
    source.indent(-1)
    source.line("return x")
    add = source.function("add", "<adds>")
    assert (add(2), add(0)) == (42, 0)


def test_where_it_fails_its_name_is_told() -> None:
    source = Source("def fail():")
    source.line("return 1 / 0")
    try:
        source.function("fail", "<fails>")()
    except ZeroDivisionError as error:
        told = "".join(traceback.format_exception(error))
    assert '"<fails>", line 2' in told


def test_no_two_names_are_the_same() -> None:
    source = Source("def f():")
    assert len({source.name("x"), source.name("x"), source.hold("x", 1), source.hold("x1", 1)}) == 4
