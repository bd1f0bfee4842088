"""The small semantic changes that tools/mutate makes to one C++ source, found in clang's syntax tree.

A mutation is one replacement of bytes that keeps the number of lines. Most can be compiled together with others, each switched on by its
number when the program runs (batched()). What is changed:
  constant   a number by 0 (a 0 by 1), twice and half of it; of whole numbers also one more; true and false
  sign       a minus left out, or put before a returned or initialising expression of arithmetic type
  operator   + and -, * and /, && and ||, their assigning forms, min and max, sin and cos
  bound      of whole numbers < and <=, > and >=; of all numbers the comparison turned round; == and !=
  term       a + b, a - b, a * b, a / b: one of the two left out; a && b and a || b likewise
  statement  an assignment, a call, ++, continue or break left out; a guard (if … return, continue, break, throw) never taken
"""
import re
from dataclasses import dataclass

from clang import cindex
from clang.cindex import CursorKind as Kind
from clang.cindex import TypeKind

NUMBER = re.compile(rb"(0[xX][0-9a-fA-F']+|[0-9][0-9']*\.?[0-9']*(?:[eE][+-]?[0-9]+)?|\.[0-9]+(?:[eE][+-]?[0-9]+)?)([uUlLfFzZ]*)$")
FLOATING = {TypeKind.DOUBLE, TypeKind.FLOAT, TypeKind.LONGDOUBLE}
WHOLE = {TypeKind.INT, TypeKind.UINT, TypeKind.LONG, TypeKind.ULONG, TypeKind.LONGLONG, TypeKind.ULONGLONG,
         TypeKind.SHORT, TypeKind.USHORT, TypeKind.CHAR_S, TypeKind.SCHAR, TypeKind.UCHAR}
ARITHMETIC = FLOATING | WHOLE | {TypeKind.BOOL}
CONSTANT = {Kind.ENUM_CONSTANT_DECL, Kind.CASE_STMT, Kind.TEMPLATE_NON_TYPE_PARAMETER}  # hold what the compiler must know
SWAPPED = {b"+": b"-", b"-": b"+", b"*": b"/", b"/": b"*", b"&&": b"||", b"||": b"&&",
           b"+=": b"-=", b"-=": b"+=", b"*=": b"/=", b"/=": b"*="}
TURNED = {b"<": b">", b">": b"<", b"<=": b">=", b">=": b"<=", b"==": b"!=", b"!=": b"=="}
NEARLY = {b"<": b"<=", b"<=": b"<", b">": b">=", b">=": b">"}
TERMS = {b"+", b"-", b"*", b"/", b"&&", b"||"}
CALLS = {b"min": b"max", b"max": b"min", b"sin": b"cos", b"cos": b"sin"}
LEAVES = {Kind.RETURN_STMT, Kind.CONTINUE_STMT, Kind.BREAK_STMT, Kind.CXX_THROW_EXPR}
WRAPPERS = {Kind.UNEXPOSED_EXPR, Kind.PAREN_EXPR}


@dataclass(frozen=True)
class Mutation:
    start: int  # bytes of the source
    end: int
    text: bytes
    kind: str
    form: str = ""  # how it is switched on: value, call, jump, guard; empty: only by itself

    def of(self, source):
        return source[:self.start] + self.text + source[self.end:]

    def switched(self, number, otherwise):
        """What stands in place of `otherwise`, which is what the source has there."""
        on = b"kGlidelabMutant == %d" % number
        return {"value": b"(" + on + b" ? (" + self.text.replace(b"\n", b" ") + b") : (" + otherwise + b"))",
                "call": b"(" + on + b" ? (void)0 : (void)(" + otherwise + b"))",
                "jump": b"if (" + on + b") {} else " + otherwise,
                "guard": b"!(" + on + b") && (" + otherwise + b")"}[self.form]


SWITCH = b"""#ifndef GLIDELAB_MUTANT
#define GLIDELAB_MUTANT
#include <cstdlib>
inline const int kGlidelabMutant = [] { const char* text = std::getenv("GLIDELAB_MUTANT"); return text ? std::atoi(text) : 0; }();
#endif
"""


def batched(source, numbered):
    """The source with all of [(number, mutation)] in it, none of them on; their places lie within each other or apart."""
    order = {"value": 0, "call": 1, "jump": 1, "guard": 2}

    def render(start, end, inside):
        at, out = start, b""
        while inside:
            low, high = inside[0][1].start, inside[0][1].end
            same = [one for one in inside if (one[1].start, one[1].end) == (low, high)]
            within = [one for one in inside if one not in same and one[1].start < high]
            inside = [one for one in inside if one[1].start >= high]
            text = render(low, high, within)
            for number, mutation in sorted(same, key=lambda one: order[one[1].form]):
                text = mutation.switched(number, text)
            out += source[at:low] + text
            at = high
        return out + source[at:end]

    return render(0, len(source), sorted(numbered, key=lambda one: (one[1].start, -one[1].end)))


def type_of(cursor):
    return cursor.type.get_canonical().kind


def core_of(cursor):
    """What stands inside parentheses and conversions that are not written."""
    while cursor.kind in WRAPPERS:
        inner = list(cursor.get_children())
        if len(inner) != 1:
            break
        cursor = inner[0]
    return cursor


class Finder:
    def __init__(self, path, source):
        self.path, self.source, self.found = path, source, set()
        self.constant_depth = 0  # within what the compiler computes
        self.loops = set()  # heads of loops: one step too many reads behind an end, which the sanitizers notice and no number

    def add(self, start, end, text, kind, form=""):
        was = self.source[start:end]
        text += b"\n" * (was.count(b"\n") - text.count(b"\n"))
        if self.constant_depth or b"//" in was:
            form = ""
        if text != was:
            self.found.add(Mutation(start, end, text, kind, form))

    def extent(self, cursor):
        extent = cursor.extent
        if extent.start.file is None or extent.start.file.name != self.path or extent.end.file.name != self.path:
            return None
        return (extent.start.offset, extent.end.offset) if extent.start.offset < extent.end.offset else None

    def visit(self, cursor):
        if cursor.kind == Kind.STATIC_ASSERT:
            return
        if self.extent(cursor):
            if cursor.kind in (Kind.INTEGER_LITERAL, Kind.FLOATING_LITERAL):
                self.constant(cursor)
            elif cursor.kind == Kind.CXX_BOOL_LITERAL_EXPR:
                start, end = self.extent(cursor)
                self.add(start, end, {b"true": b"false", b"false": b"true"}.get(self.source[start:end], b"true"), "constant", "value")
            elif cursor.kind in (Kind.BINARY_OPERATOR, Kind.COMPOUND_ASSIGNMENT_OPERATOR):
                self.binary(cursor, list(cursor.get_children()))
            elif cursor.kind == Kind.CALL_EXPR:
                self.call(cursor)
            elif cursor.kind == Kind.UNARY_OPERATOR:
                self.unary(cursor)
            elif cursor.kind == Kind.COMPOUND_STMT:
                for statement in cursor.get_children():
                    self.statement(statement)
            elif cursor.kind in (Kind.FOR_STMT, Kind.WHILE_STMT, Kind.CXX_FOR_RANGE_STMT):
                parts = list(cursor.get_children())
                self.statement(parts[-1])
                self.loops.update(self.extent(part) for part in parts[:-1])
            elif cursor.kind == Kind.IF_STMT:
                for branch in list(cursor.get_children())[1:]:
                    self.statement(branch)
            elif cursor.kind in (Kind.RETURN_STMT, Kind.VAR_DECL):
                self.negated(cursor)
        constant = cursor.kind in CONSTANT or self.is_constexpr(cursor)
        self.constant_depth += constant
        for child in cursor.get_children():
            self.visit(child)
        self.constant_depth -= constant

    def is_constexpr(self, cursor):
        where = self.extent(cursor)
        if not where or cursor.kind not in (Kind.VAR_DECL, Kind.FUNCTION_DECL, Kind.CXX_METHOD, Kind.FUNCTION_TEMPLATE, Kind.CONSTRUCTOR,
                                            Kind.FIELD_DECL, Kind.IF_STMT):
            return False
        head = self.source[max(0, where[0] - 32):max(where[0] + 16, cursor.location.offset)]
        return b"constexpr" in head[head.rfind(b";") + 1:]

    def constant(self, cursor):
        start, end = self.extent(cursor)
        number = NUMBER.match(self.source[start:end])
        if not number:
            return  # a macro wrote it
        digits, suffix = number.group(1).replace(b"'", b""), number.group(2)
        if cursor.kind == Kind.INTEGER_LITERAL:
            value = int(digits, 16) if digits[:2] in (b"0x", b"0X") else int(digits)
            index = self.source[start - 1:start] + self.source[end:end + 1] == b"[]"
            for other in {abs(value - 1)} if index else {0, value + 1, 2 * value, value // 2} if value else {1}:
                self.add(start, end, str(other).encode() + suffix, "constant", "" if index else "value")
        else:
            value = float(digits)
            for other in (0.0, 2.0 * value, 0.5 * value) if value else (1.0,):
                self.add(start, end, repr(other).encode() + suffix, "constant", "value")

    def binary(self, cursor, sides):
        if len(sides) != 2 or not all(self.extent(side) for side in sides):
            return
        (from_a, to_a), (from_b, to_b) = map(self.extent, sides)
        sign = self.source[to_a:from_b].strip()
        at = self.source.find(sign, to_a)
        a, b = self.source[from_a:to_a], self.source[from_b:to_b]
        form = "value" if type_of(cursor) in ARITHMETIC or sign[-1:] == b"=" and sign in SWAPPED else ""

        def with_sign(other):
            return self.source[from_a:at] + other + self.source[at + len(sign):to_b]

        if sign in SWAPPED:
            self.add(from_a, to_b, with_sign(SWAPPED[sign]), "operator", form)
        if sign in TERMS:
            self.add(from_a, to_b, self.as_truth(cursor, sides[0], b"(" + a + b")"), "term", form)
            other = {b"-": b"(-(" + b + b"))", b"/": b"(1 / (" + b + b"))"}.get(sign, b"(" + b + b")")
            self.add(from_a, to_b, self.as_truth(cursor, sides[1], other), "term", form)
        if sign in TURNED:
            self.add(from_a, to_b, with_sign(TURNED[sign]), "bound", form)
        if sign in NEARLY and (from_a, to_b) not in self.loops and any(type_of(core_of(side)) in WHOLE for side in sides):
            self.add(from_a, to_b, with_sign(NEARLY[sign]), "bound", form)

    def call(self, cursor):
        if cursor.spelling.startswith("operator"):
            self.binary(cursor, list(cursor.get_arguments()))
            return
        callee = next(iter(cursor.get_children()), None)
        where = callee and self.extent(callee)
        if where:
            name = re.match(rb"(?:std::)?(\w+)", self.source[where[0]:where[1]])
            if name and name.group(1) in CALLS:
                start, (first, last) = where[0] + name.start(1), self.extent(cursor)
                other = self.source[first:start] + CALLS[name.group(1)] + self.source[start + len(name.group(1)):last]
                self.add(first, last, other, "operator", "value" if type_of(cursor) in ARITHMETIC else "")

    def unary(self, cursor):
        start, end = self.extent(cursor)
        if self.source[start:start + 1] in (b"-", b"!"):
            kind = "sign" if self.source[start:start + 1] == b"-" else "operator"
            inner, written = next(iter(cursor.get_children()), cursor), b"(" + self.source[start + 1:end] + b")"
            self.add(start, end, self.as_truth(cursor, inner, written), kind, "value" if type_of(cursor) in ARITHMETIC else "")

    def as_truth(self, cursor, part, written):
        """An operand in place of a truth value: beside that value an std::optional would make one of its own of both."""
        part = core_of(part)
        made = type_of(part) != TypeKind.BOOL or part.spelling == "operator bool"
        return b"(!!" + written + b")" if type_of(cursor) == TypeKind.BOOL and made else written

    def negated(self, cursor):
        value = list(cursor.get_children())[-1:]
        if not value or not self.extent(value[0]) or type_of(value[0]) not in FLOATING:
            return
        if core_of(value[0]).kind in (Kind.FLOATING_LITERAL, Kind.INTEGER_LITERAL, Kind.UNARY_OPERATOR):
            return
        start, end = self.extent(value[0])
        if self.source[start:start + 1] not in (b"{", b":"):  # no list, no range of a loop
            self.add(start, end, b"-(" + self.source[start:end] + b")", "sign", "value")

    def statement(self, statement):
        where = self.extent(statement)
        if not where:
            return
        core = core_of(statement)
        if core.kind in (Kind.CONTINUE_STMT, Kind.BREAK_STMT, Kind.CALL_EXPR, Kind.COMPOUND_ASSIGNMENT_OPERATOR,
                         Kind.BINARY_OPERATOR, Kind.UNARY_OPERATOR):
            self.add(*where, b"(void)0", "statement", "jump" if core.kind in LEAVES else "call")
        elif core.kind == Kind.IF_STMT:
            parts = list(core.get_children())
            then = parts[1] if len(parts) == 2 else None
            if then is not None and then.kind == Kind.COMPOUND_STMT:
                inner = list(then.get_children())
                then = inner[0] if len(inner) == 1 else None
            condition = self.extent(parts[0])
            if then is not None and condition and core_of(then).kind in LEAVES and parts[0].kind != Kind.DECL_STMT:
                written = self.source[condition[0]:condition[1]]
                self.add(*condition, b"false && (" + written + b")", "statement", "guard")


def arguments_of(command):
    """Of a compiler's command line: what decides how the source is read."""
    kept, takes_next = [], False
    for word in command:
        if takes_next or word.startswith(("-I", "-D", "-std=")) or word == "-isystem":
            kept.append(word)
            takes_next = not takes_next and word in ("-isystem", "-I", "-D")
    return kept


def mutations_of(path, command):
    """All mutations of the source, in its order. `command`: a compiler's command line of the same library."""
    with open(path, "rb") as file:
        source = file.read()
    tree = cindex.Index.create().parse(path, args=["-xc++"] + arguments_of(command))
    errors = [str(d) for d in tree.diagnostics if d.severity >= cindex.Diagnostic.Error]
    if errors:
        raise ValueError(f"{path}: clang does not read it: {errors[0]}")
    finder = Finder(path, source)
    for cursor in tree.cursor.get_children():
        if cursor.location.file and cursor.location.file.name == path:
            finder.visit(cursor)
    return sorted(finder.found, key=lambda m: (m.start, m.end, m.text))
