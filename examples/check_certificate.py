"""Checks a certificate of `lindstedt certify` in whole numbers alone: python3 check_certificate.py FILE

A second program for the same theorems (docs/certificates.md), of motions that conserve energy, limit cycles and driven motions, of one
coordinate or several, whose equations have polynomials, sin, cos and exp, of periodic orbits of a linear oscillator that hits walls, and of laws on a range: the largest error of a formula for the
frequency over all amplitudes up to one, or all values of a parameter, up to infinity too, of one for that of a nonlinear normal mode over
a range of its amplitude, or of one for the duration of a contact over all speeds up to one. What a file claims of the stability is not looked at. A number is a pair (m, r) of integers, all reals within r of
m, in units of 2^-P; a series is a list of cosine coefficients, one of sine coefficients, and the norm of what is in neither. Prints what is proved, from below and from above, after every claim of the
file has been held against it, or says which inequality or claim does not hold."""
import collections
import functools
import heapq
import itertools
import json
import math
import re
import sys
import time
from fractions import Fraction
from math import isqrt
from operator import mul as product_of

P = 256                                     # binary digits behind the point
ONE = 1 << P
ZERO = (0, 0)
SIZES = {"file": 16 << 20, "number": 200, "force": 2000, "list": 800, "block": 402, "coordinates": 40}
LONGEST = 1600                              # no series has more harmonics: what is beyond is a part of its tail
SECONDS = 120                               # a file may come from anybody
MOTION, MODE, CYCLE, DRIVEN = "x''+f(x)=0", "q''+f(q)=0", "x''+g(x)*x'+h(x)=0", "x''+g(x)*x'+h(x,c,s)=0"
CYCLES, ALL_DRIVEN = "q''+g(q)*q'+h(q)=0", "q''+g(q)*q'+h(q,c,s)=0"
LAW, CONTACT = "x''+f(x,p)=0", "x''+f(x,x')=0"
LAW_OF_MODE = "a*v''+mu*f(a*v)=0"
WALLS = "x''+c*x'+k*x=constant+cosine*cos(Omega*t)+sine*sin(Omega*t)"
FUNCTIONS = ("sqrt", "sin", "cos", "exp", "log")    # of a law; a force has three of them
smallest = ONE >> 150                       # harmonics below this at the end of a series are a part of its tail
begun = time.monotonic()


class NotProved(Exception):
    pass


class Settled(NotProved):                   # on a smaller part of a range too
    pass


def demand(holds, what):
    if not holds:
        raise NotProved(what)


def in_time():
    if time.monotonic() > begun + SECONDS:
        raise Settled(f"it takes longer than {SECONDS} s")


# Numbers: everything is looked at before it is read, so that no text of any length is converted.

def of_form(pattern, text, what):
    demand(isinstance(text, str) and len(text) <= SIZES["number"] and re.fullmatch(pattern, text, re.ASCII), what)
    return text


def integer(text, what):
    return int(of_form(r"[+-]?\d+", text, f"an integer in {what}"))


def fraction(text, what):
    top, _, bottom = of_form(r"[+-]?\d+(/\d+)?", text, f"a fraction in {what}").partition("/")
    demand(bottom == "" or int(bottom) != 0, f"a fraction in {what}")
    return Fraction(int(top), int(bottom or 1))


def claim(text, what):                      # a decimal, 2.5e-33
    form = of_form(r"\d+(\.\d*)?(e[+-]?\d{1,3})?", text, f"a decimal in {what}")
    digits, _, exponent = form.partition("e")
    whole, _, decimals = digits.partition(".")
    exponent = int(exponent or 0)
    demand(abs(exponent) <= 400, f"a decimal in {what}")
    return Fraction(int(whole + decimals)) * Fraction(10) ** (exponent - len(decimals))


def whole(value, low, high, what):
    demand(type(value) is int and low <= value <= high, f"a whole number from {low} to {high} in {what}")
    return value


def integers(texts, what):
    demand(isinstance(texts, list) and len(texts) <= SIZES["list"], f"at most {SIZES['list']} numbers in {what}")
    return [integer(text, what) for text in texts]


def keys(value, needed, optional, what):
    demand(isinstance(value, dict), f"an object in {what}")
    missing, more = set(needed) - set(value), set(value) - set(needed) - set(optional)
    demand(not missing and not more, f"the keys of {what}")


# The letters of the theorem that some keys had in older certificates.
LETTERS = {"A": "initial_displacement", "K": "highest_harmonic", "Abits": "inverse_bits", "A_block": "inverse", "Omega": "driving_frequency"}


def with_names_in_words(value):
    return unique([(LETTERS.get(key, key), entry) for key, entry in value.items()]) if isinstance(value, dict) else value


def no_number(_):
    raise NotProved("a number that no certificate has")


def unique(pairs):
    names = [name for name, _ in pairs]
    demand(len(set(names)) == len(names), "a key twice")
    return dict(pairs)


# Balls.

def up(a, b):                               # a/b, rounded up
    return -(-a // b)


def number(x):                              # a fraction
    x = Fraction(x)
    m = x.numerator * ONE // x.denominator
    return m, 0 if m * x.denominator == x.numerator * ONE else 1


def dyadic(units, bits):
    return (units << P - bits, 0)


def add(a, b, sign=1):
    return a[0] + sign * b[0], a[1] + b[1]


def mul(a, b):
    if a == ZERO or b == ZERO:
        return ZERO
    r = abs(a[0]) * b[1] + abs(b[0]) * a[1] + a[1] * b[1]
    return a[0] * b[0] >> P, up(r, ONE) + 1


def total(balls):
    balls = list(balls)
    return sum(m for m, _ in balls), sum(r for _, r in balls)


def scale(a, n):                            # by an integer
    return a[0] * n, a[1] * abs(n)


def over(a, n):                             # by a positive integer
    return (a[0] // n, up(a[1], n) + 1) if a != ZERO else ZERO


def size(a):
    return abs(a[0]) + a[1]


def least(a):                               # no number of the ball is nearer to zero
    return max(0, abs(a[0]) - a[1])


def part_of(r, s):                          # of what is known by norms: the product, rounded up
    return up(r * s, ONE)


def quotient(a, b):
    demand(least(b) > 0, "a division by what may be zero")
    m = (a[0] << P) // b[0]
    return m, up(ONE * a[1] + (abs(m) + 1) * b[1], least(b)) + 1


def root(a):                                # of a positive number
    low, high = a[0] - a[1], a[0] + a[1]
    demand(low > 0, "a root of what may not be positive")
    low, high = isqrt(low << P), isqrt(high << P) + 1
    return (low + high) // 2, up(high - low, 2) + 1


# Series (cosines, sines, tail): sum a_k cos(k theta) + b_k sin(k theta) + h, |h| in the norm at most tail. b_0 is zero.

def at(u, k):
    return u[k] if k < len(u) else ZERO


def trimmed(c, s, tail):
    c, s = list(c), list(s)
    for part in (c, s):
        while part and (size(part[-1]) < smallest or len(part) > LONGEST):
            tail += size(part.pop())
    return c, s, tail


def last(u):                                # its last harmonic
    return max(len(u[0]), len(u[1]), 1) - 1


def finite(u):                              # the norm without the tail
    return sum(map(size, u[0])) + sum(map(size, u[1]))


def norm(u):
    return finite(u) + u[2]


def plus(u, v, sign=1):
    c, s = ([add(at(a, k), at(b, k), sign) for k in range(max(len(a), len(b)))] for a, b in zip(u[:2], v[:2]))
    return c, s, u[2] + v[2]


def mapped(u, change):
    return [change(a) for a in u[0]], [change(b) for b in u[1]], u[2]


def minus(u):
    return mapped(u, lambda a: (-a[0], a[1]))


def shrunk(u, n):                           # by a positive integer
    c, s, tail = mapped(u, lambda a: over(a, n))
    return c, s, up(tail, n)


def times(u, v, whole_length=False):
    """cos i cos j = (cos(i+j) + cos(i-j))/2, sin i sin j = (cos(i-j) - cos(i+j))/2, sin i cos j = (sin(i+j) + sin(i-j))/2."""
    in_time()
    demand(max(norm(u), norm(v)) >> P < 1 << 2000, "numbers that are too large")
    length = last(u) + last(v) + 1
    c, s = [[0, 0] for _ in range(length)], [[0, 0] for _ in range(length)]
    factors = [[(j, b, abs(b), r) for j, (b, r) in enumerate(part) if b or r] for part in v[:2]]
    for kind_u, part_u in enumerate(u[:2]):
        for i, a in enumerate(part_u):
            if a == ZERO:
                continue
            (a, spread), most = a, size(a)
            for j, b, size_b, r in factors[kind_u]:
                m, r = a * b, most * r + size_b * spread
                for place, term in ((c[i + j], -m if kind_u else m), (c[abs(i - j)], m)):
                    place[0] += term
                    place[1] += r
            for j, b, size_b, r in factors[1 - kind_u]:
                m, r, apart = a * b, most * r + size_b * spread, i - j if kind_u else j - i
                s[i + j][0] += m
                s[i + j][1] += r
                if apart:                   # sin(-k) = -sin(k)
                    s[abs(apart)][0] += m if apart > 0 else -m
                    s[abs(apart)][1] += r
    # Twice the sum, in units of 2^-2P.
    halved = lambda t: (t[0] >> P + 1, up(t[1], 2 * ONE) + 1) if t != [0, 0] else ZERO
    tail = up(u[2] * norm(v) + v[2] * finite(u), ONE)
    product = [halved(t) for t in c], [ZERO] + [halved(t) for t in s[1:]], tail
    return product if whole_length else trimmed(*product)


def derivative(u):                          # of a series without a tail
    demand(u[2] == 0, "a derivative of what is known in the norm alone")
    length = last(u) + 1
    return [scale(at(u[1], k), k) for k in range(length)], [scale(at(u[0], k), -k) for k in range(length)], 0


def constant(x):
    return [number(x)], [], 0


def widened(u, r):
    return u[0], u[1], u[2] + r


def without_constant(u):
    return at(u[0], 0), ([ZERO] + u[0][1:], u[1], u[2])


# The operations of such series, and of those of two angles below: the unit of their norms, and how a ball becomes one.
Operations = collections.namedtuple("Operations", "one constant plus times shrunk widened norm without_constant")
SERIES = Operations(ONE, lambda ball: ([ball], [], 0), plus, times, shrunk, widened, norm, without_constant)


def exponential_of(u, by=SERIES):
    """exp(u) = exp(c_0) exp(u - c_0)."""
    (first, y), halvings, unity = by.without_constant(u), 6, by.constant((ONE, 0))
    while by.norm(y) << 6 > by.one << halvings:
        halvings += 1
    demand(halvings < 14, "the argument of exp is too large")
    y, result = by.shrunk(y, 1 << halvings), unity
    for k in range(18, 0, -1):
        result = by.plus(unity, by.shrunk(by.times(y, result), k))
    result = by.widened(result, (by.one >> 150) + 1)    # 2^-114/19! is below 2^-170
    for _ in range(halvings):
        result = by.times(result, result)
    return by.times(result, by.constant(exponential(first)))


def sine_and_cosine(u, by=SERIES):
    halvings, unity = 0, by.constant((ONE, 0))
    while by.norm(u) << 1 > by.one << halvings:
        halvings += 1
    demand(halvings < 7, "the argument of sin is too large")
    y = by.shrunk(u, 1 << halvings)
    w, s, c = by.times(y, y), unity, unity
    for k in range(14, 0, -1):
        s, c = (by.plus(unity, by.shrunk(by.times(w, t), n), -1) for t, n in ((s, 2*k*(2*k + 1)), (c, 2*k*(2*k - 1))))
    rest = (by.one >> 128) + 1              # what is left of either series is below 2 (1/2)^30/30!
    s, c = by.widened(by.times(y, s), rest), by.widened(c, rest)
    for _ in range(halvings):
        s, c = by.times(by.times(s, c), by.constant((2 * ONE, 0))), by.plus(unity, by.times(by.times(s, s), by.constant((2 * ONE, 0))), -1)
    return s, c


# Forces: a tree of what was typed, evaluated with its first two derivatives by x.

def parse(text, letters, law=False):
    """sum := product (+|- product)*, product := power (*|/ power)*, power := atom (^ power), atom := number | letter | sin(sum) | (sum)
    A law has more functions, quotients, pi, and powers that are fractions."""
    kind, functions = ("law", FUNCTIONS) if law else ("force", ("sin", "cos", "exp"))
    unknown = f"a {kind} that this program does not know"
    demand(len(text) <= SIZES["force"], f"a {kind} of at most 2000 characters")
    decimal = r"\d+(?:\.\d*)?(?:e[-+]?\d+)?" if law else r"\d+(?:\.\d+)?"
    tokens = re.findall(rf"\s*({decimal}|[A-Za-z_][A-Za-z0-9_]*'?|[-+*/^()]|\S)", text, re.ASCII) + [""]
    place, depth = 0, 0

    def peek():
        return tokens[place]

    def take(expected=None):
        nonlocal place
        token = tokens[place]
        demand(token if expected is None else token == expected, unknown)
        place += 1
        return token

    def nested(read):
        nonlocal depth
        depth += 1
        demand(depth <= 60, f"a {kind} with too many parentheses or signs")
        tree = read()
        depth -= 1
        return tree

    def negative(tree):
        return ("*", [("number", Fraction(-1)), tree])

    def sum_of_products():
        terms = [product()]
        while peek() in ("+", "-"):
            terms.append(product() if take() == "+" else negative(product()))
        return terms[0] if len(terms) == 1 else ("+", terms)

    def product():
        if peek() == "-":
            take()
            return negative(nested(product))
        factors = [power()]
        while peek() in ("*", "/"):
            if take() == "*":
                factors.append(power())
            else:
                divisor = power()
                if law and divisor[0] != "number":
                    factors.append(("^", divisor, Fraction(-1)))
                    continue
                demand(divisor[0] == "number" and divisor[1] != 0, "a quotient that this program does not know")
                factors.append(("number", 1 / divisor[1]))
        return factors[0] if len(factors) == 1 else ("*", factors)

    def power():
        base = atom()
        if peek() != "^":
            return base
        take()
        if law:
            sign = -1 if peek() == "-" and take() else 1
            return ("^", base, sign * exponent_of(atom()))
        exponent = take()
        demand(exponent.isdecimal() and len(exponent) <= 3 and int(exponent) <= 200, "a power that this program does not know")
        return ("^", base, int(exponent))

    def atom():
        token = take()
        if token in functions + ("(",):
            if token != "(":
                take("(")
            inner = nested(sum_of_products)
            take(")")
            return inner if token == "(" else ("^", inner, Fraction(1, 2)) if token == "sqrt" else (token, inner)
        if token in letters:
            return ("letter", token)
        if law:
            return ("pi",) if token == "pi" else ("number", claim(token, "the law"))
        demand(re.fullmatch(r"\d+(\.\d+)?", token, re.ASCII) and len(token) <= SIZES["number"], unknown)
        return ("number", Fraction(token))

    tree = sum_of_products()
    demand(peek() == "", unknown)
    return tree


def exponent_of(tree):                      # a fraction, of numbers alone
    kind = tree[0]
    if kind == "number":
        value = tree[1]
    else:
        demand(kind in "+*" or (kind == "^" and tree[2] == -1), "a power that this program does not know")
        parts = [exponent_of(part) for part in (tree[1] if kind in "+*" else [tree[1]])]
        demand(kind != "^" or parts[0] != 0, "a power that this program does not know")
        value = sum(parts) if kind == "+" else math.prod(parts) if kind == "*" else 1 / parts[0]
    demand(abs(value) <= 200 and value.denominator <= 10 ** 9, "a power that this program does not know")
    return Fraction(value)


def read_force(value, letters, what):
    if isinstance(value, list):
        demand(len(value) <= SIZES["number"], f"a polynomial of a degree below 200 in {what}")
        tree = ("number", Fraction(0))
        for a in reversed([fraction(a, what) for a in value]):
            tree = ("+", [("number", a), ("*", [("letter", "x"), tree])])
        return tree
    demand(isinstance(value, str), f"a force in {what}")
    return parse("sin(x)" if value == "sin" else value, letters)


def jets(tree, waves, names):
    """f, its first derivatives by these letters, and its second ones, of series of the letters."""
    kind, zero, places = tree[0], ([], [], 0), range(len(names))
    flat = lambda f, first=None: (f, first or [zero] * len(names), [[zero] * len(names) for _ in places])
    if kind == "number":
        return flat(constant(tree[1]))
    if kind == "letter":
        return flat(waves[tree[1]], [constant(1) if name == tree[1] else zero for name in names])
    if kind == "+":
        result = flat(zero)
        for part in tree[1]:
            f, df, ddf = jets(part, waves, names)
            result = (plus(result[0], f), [plus(a, b) for a, b in zip(result[1], df)],
                      [[plus(a, b) for a, b in zip(*rows)] for rows in zip(result[2], ddf)])
        return result
    if kind == "*":
        product = jets(tree[1][0], waves, names)
        for factor in tree[1][1:]:
            product = jet_times(product, jets(factor, waves, names))
        return product
    if kind == "^":
        base, result, n = jets(tree[1], waves, names), flat(constant(1)), tree[2]
        while n:                            # squares
            if n & 1:
                result = jet_times(result, base)
            n >>= 1
            if n:
                base = jet_times(base, base)
        return result
    u, du, ddu = jets(tree[1], waves, names)
    if kind == "exp":
        f = df = ddf = exponential_of(u)
    else:
        s, c = sine_and_cosine(u)
        f, df, ddf = (s, c, minus(s)) if kind == "sin" else (c, minus(s), minus(c))
    second = lambda i, j: plus(times(ddf, times(du[i], du[j])), times(df, ddu[i][j]))
    return f, [times(df, part) for part in du], [[second(i, j) for j in places] for i in places]


def jet_times(a, b):
    places = range(len(a[1]))

    def second(i, j):
        mixed = plus(times(a[1][i], b[1][j]), times(a[1][j], b[1][i]))
        return plus(plus(times(a[2][i][j], b[0]), times(a[0], b[2][i][j])), mixed)

    first = [plus(times(a[1][i], b[0]), times(a[0], b[1][i])) for i in places]
    return times(a[0], b[0]), first, [[second(i, j) for j in places] for i in places]


def parity(tree, turned):
    """1 where the force stays as it is with these letters of the other sign, -1 where it changes its own, 0 where neither is seen, None of
    nothing: written out as a polynomial, or part by part."""
    terms = expanded(tree)
    if terms is not None:
        signs = {(-1) ** sum(n for letter, n in monomial if letter in turned) for monomial in terms}
        return None if not signs else signs.pop() if len(signs) == 1 else 0
    return parity_by_parts(tree, turned)


def parity_by_parts(tree, turned):
    kind = tree[0]
    if kind == "number":
        return 1 if tree[1] else None
    if kind == "letter":
        return -1 if tree[1] in turned else 1
    if kind == "+":
        signs = {parity_by_parts(part, turned) for part in tree[1]} - {None}
        return None if not signs else signs.pop() if len(signs) == 1 else 0
    if kind == "*":
        product = 1
        for factor in tree[1]:
            sign = parity_by_parts(factor, turned)
            if sign is None:
                return None
            product *= sign
        return product
    inner = parity_by_parts(tree[1], turned)
    if kind == "^":
        return 1 if tree[2] == 0 else None if inner is None else inner ** tree[2]
    if inner in (1, None):
        return 1
    return {"sin": -1, "cos": 1, "exp": 0}[kind] if inner == -1 else 0


def expanded(tree, atoms=False):
    """The polynomial as a table of monomials; None where it is none, or too long. With atoms sin, cos and exp are letters."""
    kind = tree[0]
    if kind == "number":
        return {(): tree[1]} if tree[1] else {}
    if kind == "letter":
        return {((tree[1], 1),): Fraction(1)}
    if kind in ("sin", "cos", "exp"):
        return {((repr(tree), 1),): Fraction(1)} if atoms else None
    parts = [expanded(part, atoms) for part in tree[1]] if kind in "+*" else [expanded(tree[1], atoms)] * tree[2]
    if any(part is None for part in parts):
        return None
    if kind == "+":
        total = {}
        for part in parts:
            for monomial, value in part.items():
                total[monomial] = total.get(monomial, 0) + value
        return {monomial: value for monomial, value in total.items() if value}
    total = {(): Fraction(1)}
    for part in parts:
        product = {}
        in_time()
        if len(total) * len(part) > 10000 or any(long(value) for value in total.values()):
            return None
        for one, value in total.items():
            for other, factor in part.items():
                powers = dict(one)
                for letter, n in other:
                    powers[letter] = powers.get(letter, 0) + n
                monomial = tuple(sorted(powers.items()))
                product[monomial] = product.get(monomial, 0) + value * factor
        total = {monomial: value for monomial, value in product.items() if value}
    return total


def long(x):
    return max(x.numerator.bit_length(), x.denominator.bit_length()) > 10000


def is_mirror_image(g, h, turned):          # every g even and every h odd
    return all(parity(tree, turned) in (1, None) for row in g for tree in row) and all(parity(tree, turned) in (-1, None) for tree in h)


def slope(tree, name):
    """The derivative by a letter."""
    kind = tree[0]
    if kind in ("number", "letter"):
        return ("number", Fraction(1 if tree == ("letter", name) else 0))
    if kind == "+":
        return ("+", [slope(part, name) for part in tree[1]])
    if kind == "*":
        others = lambda place: tree[1][:place] + tree[1][place + 1:]
        return ("+", [("*", [slope(part, name)] + others(place)) for place, part in enumerate(tree[1])])
    inner = slope(tree[1], name)
    if kind == "^":
        return ("*", [("number", Fraction(tree[2])), ("^", tree[1], tree[2] - 1), inner]) if tree[2] else ("number", Fraction(0))
    if kind == "exp":
        return ("*", [tree, inner])
    return ("*", [("cos", tree[1]), inner] if kind == "sin" else [("number", Fraction(-1)), ("sin", tree[1]), inner])


def is_potential(row, names):               # the derivatives of one function: dg_j/dq_l = dg_l/dq_j
    for j, one in enumerate(names):
        for l in range(j):
            apart = ("+", [slope(row[j], names[l]), ("*", [("number", Fraction(-1)), slope(row[l], one)])])
            if expanded(apart, True) != {}:
                return False
    return True


# What both theorems share.

class Block:
    """The matrix of the approximate inverse, on a first unknown of the weight sigma (where there is one) and harmonics."""

    def __init__(self, rows, bits, sigma):
        self.rows = [[dyadic(entry, bits) for entry in row] for row in rows]
        self.sigma = sigma                  # None where all weigh the same
        self.size = len(rows)

    def norm(self, v):
        first = size(v[0]) if self.sigma is None else up(self.sigma.numerator * size(v[0]), self.sigma.denominator)
        return first + sum(map(size, v[1:]))

    def column(self, k):
        return self.norm([row[k] for row in self.rows])

    def image(self, v):
        used = [(k, a) for k, a in enumerate(v) if a != ZERO]
        result = []
        for row in self.rows:
            m = r = 0
            for k, a in used:
                b = row[k]
                m += a[0] * b[0]
                r += abs(b[0]) * a[1]
            result.append((m >> P, up(r, ONE) + 1))
        return result

    def per_sigma(self, t):
        return up(t * self.sigma.denominator, self.sigma.numerator)


def unit(v, k):                             # less the unit vector
    return [add(a, (ONE, 0), -1) if i == k else a for i, a in enumerate(v)]


def radius(Y0, Z1, curvature, distinct):
    """r = 2 Y0/((1 - Z1) + sqrt(D)), D = (1 - Z1)^2 - 2 Y0 Z2, with Z2 on the ball of radius R >= r."""
    demand(Z1 < ONE, f"Z1 = {Z1 / ONE:.3g} is not below 1")
    reason = "D is not positive"
    for percent in (105, 800, 6400):
        R = up(percent * 2 * Y0 * ONE, 100 * (ONE - Z1))
        Z2 = curvature(R)
        D = (ONE - Z1) ** 2 - 2 * Y0 * Z2
        if D <= 0:
            continue
        r = up(2 * Y0 * ONE, ONE - Z1 + isqrt(D))
        if r <= R and Z1 + up(Z2 * r, ONE) < ONE and distinct(r):
            return r
        reason = "the radius is too large"
    raise NotProved(reason)


class Swings:
    """q'' + f(q) = 0, q'(0) = 0: -k^2 c_ik + mu f_ik = 0, and sum_k c_sk given where the condition is a place s among the coordinates, or
    sum_i p_i c_i1 where it is a list of factors. One coordinate is one of several. Bounds about mu and X; B holds for the harmonics of the
    block, and beyond it stands -1/k^2. Others are series of further letters of f."""

    def __init__(self, forces, names, condition, B, harmonics, odd, mu, X, others={}):
        self.forces, self.names, self.condition, self.B, self.mu, self.X, self.others = forces, names, condition, B, mu, X, others
        self.count, self.N, self.step = range(len(names)), harmonics[-1], 2 if odd else 1
        self.block = [(i, k) for i in self.count for k in harmonics]
        parts = self.jets_of(X)
        self.F, self.G = [part[0] for part in parts], [part[1] for part in parts]
        demand(not any(u[1] for u in self.F) and not any(u[1] for row in self.G for u in row), "sines in a force along cosines")
        self.of_start = B.column(0)
        beyond = up(ONE + (self.of_start if any(map(self.felt, self.count)) else 0), (self.N + self.step) ** 2)
        self.alpha = max([B.column(k) for k in range(1, B.size)] + [beyond])

    def jets_of(self, X):
        return [jets(f, {**self.others, **dict(zip(self.names, X))}, self.names) for f in self.forces]

    def felt(self, i):                      # whether the condition feels the harmonics of a coordinate beyond the block
        return self.condition == i

    def sum_felt(self, balls):
        return total(ball for (i, _), ball in balls.items() if self.felt(i))

    def beyond(self, end, begin=0):
        return [(i, k) for i in self.count for k in range(self.N + self.step, end + 1, self.step) if k >= begin]

    def conditioned(self, lists):           # the left side of the condition
        if isinstance(self.condition, int):
            return total(lists[self.condition])
        return total(mul(p, at(c, 1)) for p, c in zip(self.condition, lists))

    def turned(self, start, left, end):
        """The norm of B of what is left of the condition, and of the equations of the harmonics up to the end."""
        y = {(i, k): over(left(i, k), k * k) for i, k in self.beyond(end)}
        return self.B.norm(self.B.image([add(start, self.sum_felt(y))] + [left(i, k) for i, k in self.block])) + sum(map(size, y.values()))

    def unseen(self, tails):                # the same of parts of mu f that are known by this norm
        return part_of(self.alpha, tails)

    def defect(self, A):                    # Y0
        lists = [u[0] for u in self.X]
        left = lambda i, k: add(mul(self.mu, at(self.F[i][0], k)), scale(at(lists[i], k), -k * k))
        Y = self.turned(add(self.conditioned(lists), number(A), -1), left, max(len(u[0]) for u in self.X + self.F))
        return Y + self.unseen(part_of(size(self.mu), sum(u[2] for u in self.F)))

    def contraction(self):                  # Z1
        B, F, G, N, step, count, mu, condition = self.B, self.F, self.G, self.N, self.step, self.count, self.mu, self.condition
        places = {wave: n + 1 for n, wave in enumerate(self.block)}
        halves = [[[over(g, 2) if k else g for k, g in enumerate(u[0])] for u in row] for row in G]

        def M(row, column):
            (i, k), (j, m) = row, column
            h = halves[i][j]
            return at(G[i][j][0], k) if m == 0 else at(h, m) if k == 0 else add(at(h, abs(k - m)), at(h, k + m))

        L = max(len(u[0]) for row in G for u in row)
        images = {(i, k): over(at(F[i][0], k), k * k) for i, k in self.beyond(max(len(u[0]) for u in F))}
        column = B.norm(unit(B.image([self.sum_felt(images)] + [at(F[i][0], k) for i, k in self.block]), 0))
        worst = B.per_sigma(column + sum(map(size, images.values())) + self.unseen(sum(u[2] for u in F)))
        felt = [part_of(size(mu), ONE + (self.of_start if self.felt(i) else 0)) for i in count]
        at_far = max(sum(part_of(felt[i], finite(G[i][j])) for i in count) for j in count)
        m = 1 if step == 2 else 0
        while True:
            for wave in ((j, m) for j in count):
                images = {row: over(mul(mu, M(row, wave)), row[1] ** 2) for row in self.beyond(m + L, m - L)}
                start, tail = self.sum_felt(images), sum(map(size, images.values()))
                if m > N + L:
                    worst = max(worst, tail + part_of(self.of_start, size(start)))
                    continue
                if m <= N and self.felt(wave[0]):
                    start = add(start, (ONE, 0))
                elif m == 1 and not isinstance(condition, int):
                    start = add(start, condition[wave[0]])
                v = B.image([start] + [add(mul(mu, M(row, wave)), (-m * m * ONE if row == wave else 0, 0)) for row in self.block])
                worst = max(worst, B.norm(unit(v, places[wave]) if wave in places else v) + tail)
                demand(worst < ONE, f"Z1 = {worst / ONE:.3g} is not below 1")
            far = m + step - L              # all further columns together
            if far > 0 and m > N + L:
                rest = up(at_far, far * far)
                if 5 * rest < ONE or rest < worst:
                    worst = max(worst, rest)
                    break
            demand(m < 8000, "a force too steep for its columns to be bounded")
            m += step
        return worst + self.unseen(part_of(size(mu), max(sum(G[i][j][2] for i in count) for j in count)))

    def curvature(self, R):                 # Z2
        ball = self.jets_of([widened(u, R) for u in self.X])
        first = max(sum(norm(df[j]) for _, df, _ in ball) for j in self.count)
        second = max(sum(norm(ddf[j][m]) for _, _, ddf in ball) for j in self.count for m in self.count)
        return part_of(self.alpha, max(self.B.per_sigma(first), part_of(size(self.mu) + self.B.per_sigma(R), second)))

    def is_distinct(self, r):               # neither rest nor a shorter period is as near
        return self.B.per_sigma(r) < self.mu[0] and r < max(least(at(u[0], 1)) for u in self.X)


def prove_motion(forces, names, condition, A, B, harmonics, odd, mu, X):
    swings = Swings(forces, names, condition, B, harmonics, odd, mu, X)
    return radius(swings.defect(A), swings.contraction(), swings.curvature, swings.is_distinct)


def wave_of(X, wave):                       # the coefficient of a cosine or sine, kind 0 or 1, of a coordinate
    i, kind, k = wave
    return at(X[i][kind], k)


def prove_damped(g, h, names, waves, B, block, N, step, p, phase):
    """q'' + g(q) q' + h = 0, X(theta), p = 1/omega: -k^2 X_k + p D_k + p^2 h_k = 0, D = g(X) X'. One coordinate is one of several; phase
    is the coordinate whose sine of the first harmonic p replaces among the unknowns, None where p is known."""
    free, count = phase is not None, range(len(names))
    X = [waves[name] for name in names]
    jets_of = lambda trees, waves: [jets(tree, waves, names) for tree in trees]
    G, H = [jets_of(row, waves) for row in g], jets_of(h, waves)
    D = [functools.reduce(plus, (times(G[i][j][0], derivative(X[j])) for j in count)) for i in count]
    F = [part[0] for part in H]
    p2 = mul(p, p)
    offset = 1 if free else 0               # unknowns that are no harmonics
    columns = [B.column(k) for k in range(B.size)]
    alpha = max(columns + [up(ONE, (N + 1) ** 2)])
    beta = max([wave[2] * t for wave, t in zip(block, columns)] + [up(ONE, N + 1)])
    bounded = lambda t, e: up(t * e, ONE)
    beyond = lambda end: [(i, kind, k) for i in count for k in range(N + step, end + 1, step) for kind in (0, 1)]
    end = max(map(last, X + D + F))
    bent = lambda w: add(mul(p, wave_of(D, w)), mul(p2, wave_of(F, w)))
    own = lambda w: add(bent(w), scale(wave_of(X, w), -w[2] ** 2))
    rest = [over(own(w), w[2] ** 2) for w in beyond(end)]
    tails = lambda series: sum(u[2] for u in series)
    unseen = bounded(size(p), tails(D)) + bounded(size(p2), tails(F))
    Y0 = B.norm(B.image([own(w) for w in block])) + sum(map(size, rest)) + bounded(alpha, unseen)
    # Z1
    worst = 0
    if free:
        by_p = lambda w: add(wave_of(D, w), scale(mul(p, wave_of(F, w)), 2))
        tail = sum(size(over(by_p(w), w[2] ** 2)) for w in beyond(end))
        unseen = bounded(alpha, tails(D) + 2 * bounded(size(p), tails(F)))
        worst = B.per_sigma(B.norm(unit(B.image([by_p(w) for w in block]), 0)) + tail + unseen)
    bare = lambda u: (u[0], u[1], 0)
    G0, H1 = [[bare(G[i][j][0]) for j in count] for i in count], [[bare(H[i][1][j]) for j in count] for i in count]
    # Of a matrix of series the largest sum of a column.
    column_norm = lambda entry, measure: max(sum(measure(entry(i, j)) for i in count) for j in count)
    unseen = bounded(beta, bounded(size(p), column_norm(lambda i, j: G[i][j][0], lambda u: u[2])))
    unseen += bounded(alpha, bounded(size(p2), column_norm(lambda i, j: H[i][1][j], lambda u: u[2])))
    W = max(last(u) for matrix in (G0, H1) for row in matrix for u in row)
    places = {w: k for k, w in enumerate(block) if k >= offset}
    j = min(k for _, _, k in block)
    far_g, far_h = column_norm(lambda i, j: G0[i][j], norm), column_norm(lambda i, j: H1[i][j], norm)
    while True:
        for wave in ((i, kind, j) for i in count for kind in (0, 1)):
            if wave[1:] == (1, 0) or (free and wave == (phase, 1, 1)):
                continue
            e = ([ZERO] * j + [(ONE, 0)], [], 0) if wave[1] == 0 else ([], [ZERO] * j + [(ONE, 0)], 0)
            drag = [derivative(times(G0[i][wave[0]], e, True)) for i in count]
            bend = [times(H1[i][wave[0]], e, True) for i in count]
            moved = lambda w: add(mul(p, wave_of(drag, w)), mul(p2, wave_of(bend, w)))
            tail = sum(size(over(moved(w), w[2] ** 2)) for w in beyond(j + W) if w[2] >= j - W)
            if j > N + W:
                worst = max(worst, tail)
                continue
            v = B.image([add(moved(w), (-w[2] ** 2 * ONE if w == wave else 0, 0)) for w in block])
            worst = max(worst, B.norm(unit(v, places[wave]) if wave in places else v) + tail)
            demand(worst < ONE, f"Z1 = {worst / ONE:.3g} is not below 1")
        if j > N + W:
            far = j + step - W
            more = up(bounded(size(p), far_g), far) + up(bounded(size(p2), far_h), far * far)
            if 5 * more < ONE or more < worst:
                worst = max(worst, more)
                break
        demand(j < 8000, "a force too steep for its columns to be bounded")
        j += step
    Z1 = worst + unseen

    def curvature(R):
        ball = dict(waves, **{name: widened(u, R) for name, u in zip(names, X)})
        G_R, H_R = [jets_of(row, ball) for row in g], jets_of(h, ball)
        most = size(p) + (B.per_sigma(R) if free else 0)
        sums = lambda part: sum(map(norm, part))
        dg = max(sums(G_R[i][j][1][l] for i in count) for j in count for l in count)
        ddh = max(sums(H_R[i][2][j][l] for i in count) for j in count for l in count)
        of_motion = bounded(beta, bounded(most, dg)) + bounded(alpha, bounded(bounded(most, most), ddh))
        if not free:
            return of_motion
        both = B.per_sigma(B.per_sigma(2 * bounded(alpha, sums(part[0] for part in H_R))))
        g_R, dh_R = column_norm(lambda i, j: G_R[i][j][0], norm), column_norm(lambda i, j: H_R[i][1][j], norm)
        each = B.per_sigma(bounded(beta, g_R) + 2 * bounded(most, bounded(alpha, dh_R)))
        return max(both, each, of_motion)

    a1 = at(X[phase][0], 1) if free else None
    return radius(Y0, Z1, curvature, lambda r: not free or (B.per_sigma(r) < p[0] and r < a1[0]))


# What follows for the formula.

def largest(u, claimed):
    """max |u| from both sides, by bisection: |u| <= |u(t)| + h |u'(t)| + h^2/2 sum k^2 (|a_k| + |b_k|) within h of t. It goes on until
    the claims hold or nothing is gained."""
    low_claim, high_claim = claimed
    du, bend = derivative(u), sum(k * k * (size(at(u[0], k)) + size(at(u[1], k))) for k in range(last(u) + 1))
    if finite(u) == 0:
        return 0, 0
    pieces = 4 * (last(u) + 1)
    two_pi = 2 * PI[0], 2 * PI[1]
    best, queue = 0, []

    def put(place, count):                  # the piece about the angle 2 pi place/count, of the half width pi/count
        nonlocal best
        t = over(scale(two_pi, place), count)
        value, slope = values(u, du, t)
        h = up(PI[0] + PI[1], count) + t[1]
        above = size(value) + up(h * size(slope), ONE) + up(up(h * h, ONE) * bend, 2 * ONE)
        best = max(best, least(value))
        heapq.heappush(queue, (-above, place, count))

    for place in range(pieces):
        put(place, pieces)
    for _ in range(20000):
        above, place, count = -queue[0][0], queue[0][1], queue[0][2]
        enough = above <= high_claim and best >= low_claim
        if enough or above - best <= (best >> 40) + (ONE >> 200) or above < best:
            break
        heapq.heappop(queue)
        for part in (-1, 0, 1):
            put(3 * place + part, 3 * count)
    return best, max(best, -queue[0][0])


def values(u, du, t):
    s, c = angle(t)
    value, slope = ZERO, ZERO
    turn = (ONE, 0), ZERO
    for k in range(last(u) + 1):
        value = add(value, add(mul(at(u[0], k), turn[0]), mul(at(u[1], k), turn[1])))
        slope = add(slope, add(mul(at(du[0], k), turn[0]), mul(at(du[1], k), turn[1])))
        turn = add(mul(turn[0], c), mul(turn[1], s), -1), add(mul(turn[1], c), mul(turn[0], s))
    return value, slope


def angle(t):                               # sine and cosine of a number
    return tuple((at(v[0], 0)[0], at(v[0], 0)[1] + v[2]) for v in sine_and_cosine(([t], [], 0)))


def arctangent_of_reciprocal(n):
    power, total, k = over((ONE, 0), n), ZERO, 1
    while size(power) > 2:
        total = add(total, over(power, k), 1 if k % 4 == 1 else -1)
        power, k = over(power, n * n), k + 2
    return total[0], total[1] + size(power)


PI = add(scale(arctangent_of_reciprocal(5), 16), scale(arctangent_of_reciprocal(239), 4), -1)


def turned(u, c, s):                        # at an angle that is larger by one of this cosine and sine
    cosines, sines, turn = [], [], ((ONE, 0), ZERO)
    for k in range(last(u) + 1):
        a, b = at(u[0], k), at(u[1], k)
        cosines.append(add(mul(a, turn[0]), mul(b, turn[1])))
        sines.append(add(mul(b, turn[0]), mul(a, turn[1]), -1))
        turn = add(mul(turn[0], c), mul(turn[1], s), -1), add(mul(turn[1], c), mul(turn[0], s))
    return cosines, sines, u[2]


def mean(u):                                # no more than the root of the mean square
    squares = 2 * least(at(u[0], 0)) ** 2 + sum(least(a) ** 2 for part in u[:2] for a in part[1:])
    return isqrt(squares // 2)


def deviation(copies, own, r, claimed):
    """max |X - X~| of the nearest of the motions that the symmetries of the equation make of X."""
    low, high = (units(t) for t in claimed)
    apart = sorted(((mean(d), d) for d in (plus(copy, own, -1) for copy in copies)), key=lambda t: t[0])
    below, above = None, None
    for average, d in apart:
        if above is not None and average >= above:
            break
        one, other = largest(d, (low + r, high - r))
        below = one if below is None else min(below, one)
        above = other if above is None else min(above, other)
    return max(0, below - r), above + r


def units(x):                               # below a fraction
    return x.numerator * ONE // x.denominator


def hold(proved, claimed, what):
    low, high = claimed
    demand(Fraction(proved[1], ONE) <= high and low <= Fraction(proved[0], ONE), f"{what} is not as claimed")


def apart(a, b):
    d = add(a, b, -1)
    return least(d), size(d)


def pair(value, what):
    demand(isinstance(value, list) and len(value) == 2, f"two decimals in {what}")
    return [claim(text, what) for text in value]


def check_formula(z, kind, bits, copies, r, omega, amplitude, start):
    """Every claim about the formula; r is the radius, omega or amplitude a ball."""
    formula = z["formula"]
    needed = {"law", "c", "phase_error"} | ({"amplitude_error"} if kind == DRIVEN else {"omega", "frequency_error", "drift"})
    keys(formula, needed | ({"s"} if kind not in (MOTION, MODE) else set()), {"values", "letters"}, "formula")
    for key in ("law", "values"):                # words, of which nothing is checked here
        demand(isinstance(formula.get(key, ""), str) and len(formula.get(key, "")) <= SIZES["file"], f"a text in {key}")
    claimed = pair(formula["phase_error"], "phase_error")
    if kind == MODE:
        check_formula_of_mode(z, bits, copies, r, omega, start, claimed)
        return
    c, s = integers(formula["c"], "formula.c"), integers(formula.get("s", []), "formula.s")
    own = [dyadic(a, bits) for a in c], [ZERO] + [dyadic(b, bits) for b in s[1:]], 0
    if kind == DRIVEN:
        a = formula_amplitude(own, z["drive"]["harmonic"])
        hold(apart(a, amplitude), pair(formula["amplitude_error"], "amplitude_error"), "the error of the amplitude")
        hold(deviation(copies, own, r, claimed), claimed, "the deviation")
        return
    own_omega = dyadic(integer(formula["omega"], "omega"), bits)
    demand(own_omega[0] > 0, "a formula whose frequency is not positive")
    demand(any(len(part) > 1 and part[1] for part in (c, s)), "a formula without a first harmonic")
    if kind == CYCLE:                       # until its first harmonic is a positive cosine
        a, b = at(own[0], 1), at(own[1], 1)
        if b != ZERO or a[0] < 0:
            length = root(add(mul(a, a), mul(b, b)))
            own = turned(own, quotient(a, length), quotient(b, length))
    else:
        begin = add(total(own[0]), number(start), -1)
        demand(least(begin) <= finite(own) >> 20, "a formula that begins elsewhere than the motion")
    off = apart(own_omega, omega)
    hold(off, pair(formula["frequency_error"], "frequency_error"), "the error of the frequency")
    hold(deviation(copies, own, r, claimed), claimed, "the deviation")
    hold_drift(formula, off, [own])


def hold_drift(formula, off, motions):      # of several coordinates the largest
    drift = pair(formula["drift"], "drift")
    low, high = units(drift[0]) * ONE // max(1, off[0]) + 1, up(units(drift[1]) * ONE, max(1, off[1])) - 1
    steep = largest_of([derivative(own) for own in motions], lambda u, low: largest(u, (low, high)), low)
    hold((steep[0] * off[0] >> P, up(steep[1] * off[1], ONE)), drift, "the drift")


def largest_of(parts, ends, low):
    """The largest of some sizes, each from both sides by a function of it and of the lower claim, which one of them alone has to reach."""
    if len(parts) == 1:
        return ends(parts[0], low)
    found = [ends(part, 0) for part in parts]
    for place, part in enumerate(parts):
        if max(below for below, _ in found) < low <= found[place][1]:
            found[place] = ends(part, low)
    return tuple(max(end) for end in zip(*found))


def check_formula_of_mode(z, bits, X, r, omega, start, claimed):
    formula, (condition, A) = z["formula"], start
    lists = formula["c"]
    demand(isinstance(lists, list) and len(lists) == len(X), "a formula of another number of coordinates")
    motions = [([dyadic(a, bits) for a in integers(c, "formula.c")], [], 0) for c in lists]
    own_omega = dyadic(integer(formula["omega"], "omega"), bits)
    demand(own_omega[0] > 0, "a formula whose frequency is not positive")
    demand(any(at(u[0], 1) != ZERO for u in motions), "a formula without a first harmonic")
    measured = total(motions[condition][0]) if isinstance(condition, int) else total(mul(p, at(u[0], 1)) for p, u in zip(condition, motions))
    demand(least(measured) > 0 and (measured[0] < 0) == (A < 0), "a formula that begins elsewhere than the motion")
    off = apart(own_omega, omega)
    hold(off, pair(formula["frequency_error"], "frequency_error"), "the error of the frequency")
    ends = lambda both, low: deviation([both[0]], both[1], r, (Fraction(low, ONE), claimed[1]))
    hold(largest_of(list(zip(X, motions)), ends, units(claimed[0])), claimed, "the deviation")
    hold_drift(formula, off, motions)


def formula_amplitude(u, harmonic):
    a, b = at(u[0], harmonic), at(u[1], harmonic)
    square = add(mul(a, a), mul(b, b))
    if square[0] - square[1] > 0:
        return root(square)
    return 0, size(a) + size(b)


# Laws on a range. The motion from rest at a turns at b, where V(b) = V(a). Along x = m + r cos(theta), between b = m - r and a = m + r,
# f = sum_k F_k cos(k theta), and G = 2 (V(a) - V(x))/(r sin(theta))^2, so that 1/omega is the mean of G^(-1/2). V(a) - V(x) is r times
# the integral of f sin from 0 to theta. Over the whole way that is (V(a) - V(b))/r = 2 S[f], S[f] = sum_{even k} F_k/(1 - k^2); what F_0
# gives is taken from S[f] = 0, and then r G = L[f] with L[cos(theta)] = 1, L[1] = 0 and
# L[cos(k theta)] = 4/(k^2 - 1) sum_{0 < l < k, k - l odd} l cos(l theta),
# of the norm 1 where k is odd, k^2/(k^2 - 1) where it is even: no more than 4/3 times the norm of f. An odd force has m = 0 and odd k
# alone. Wherever a real m with S[f] = 0 has a G > 0, the motion from rest at a is the one between these ends. The norms hold for complex
# values too: a ball of the variable stands for a disc where no root of it is taken.

NODES = [round(65536 * math.cos(math.pi * (i + 0.5) / 16)) for i in range(16)]      # in units of 2^-16, near the points of Chebyshev
WIDER = 4                                   # the radius of the disc on which 1/omega is bounded, over half of the piece
MOST_GROWTH = 12                            # the degree of a force in a parameter that goes to infinity


def reach(x):                               # of a positive fraction, rounded up
    return up(x.numerator * ONE, x.denominator)


def enlarged(a, r):
    return a[0], a[1] + r


class Family:
    """The motions x'' + f(x, v) = 0 from rest at x = start, or at v where start is None, of an f that is odd in x."""

    def __init__(self, force, name, start):
        self.force, self.name, self.start = force, name, start
        # Along the motion what the variable changes: x at the rate cos(theta), or a parameter.
        self.letter, self.way = ("x", ([ZERO, (ONE, 0)], [], 0)) if start is None else (name, constant(1))

    def amplitude(self, v):
        return v if self.start is None else number(self.start)

    def along(self, v, names):
        f, df, ddf = jets(self.force, {"x": ([ZERO, self.amplitude(v)], [], 0), self.name: ([v], [], 0)}, names)
        demand(not any(u[1] for u in [f] + df), "sines in a force along cosines")
        return f, df, ddf

    def stiffness(self):                    # at rest, of a force without a parameter
        u = jets(self.force, {"x": ([], [], 0)}, ("x",))[1][0]
        return at(u[0], 0)[0], at(u[0], 0)[1] + u[2]

    def inverse_frequency(self, v):
        if self.start is None and v == ZERO:
            return root(quotient((ONE, 0), self.stiffness()))
        return mean_of_root(divided(rate(self.along(v, ())[0]), self.amplitude(v)))

    def bound_on_disc(self, middle, radius):
        """A bound of |1/omega| for complex v within the radius of the middle, by the mean value of G."""
        v, spread = number(middle), reach(radius)
        everywhere, first, second = enlarged(v, spread), self.along(v, (self.letter,)), self.along(enlarged(v, spread), (self.letter,))
        f, slope = first[0], times(first[1][0], self.way)
        bend = norm(times(second[2][0][0], times(self.way, self.way)))
        if self.start is not None:
            a = number(self.start)
            slope = norm(divided(rate(widened(slope, part_of(spread, bend))), a))
            return bound_of_root(widened(divided(rate(f), a), part_of(spread, slope)))
        # G = k + L[h]/a with h = f - k x, and G' = L[h']/a - L[h]/a^2.
        k = self.stiffness()
        h, slope = plus(f, ([ZERO, mul(k, v)], [], 0), -1), widened(plus(slope, ([ZERO, k], [], 0), -1), part_of(spread, bend))
        own, changed = divided(rate(h), v), divided(rate(slope), everywhere)
        bent = divided(divided(rate(widened(h, part_of(spread, norm(slope)))), everywhere), everywhere)
        return bound_of_root(widened(plus(([k], [], 0), own), part_of(spread, norm(plus(changed, bent, -1)))))

    def bound_about_rest(self, radius):
        """The same for |a| up to the radius: f = f'(0) x + x^2 int_0^1 (1 - s) f''(s x) ds."""
        spread = reach(radius)
        bend = norm(times(self.along((0, spread), ("x",))[2][0][0], times(self.way, self.way)))
        return bound_of_root(([self.stiffness()], [], up(part_of(spread, bend), 2)))

    def piece(self, low, high):
        """1/omega between these values: a polynomial in e = (v - middle)/half through values at the nodes. With |1/omega| <= M on the disc
        it is off by less than M rho/(rho - h) max|w|/(rho - h)^16."""
        middle, half = (low + high) / 2, (high - low) / 2
        radius = WIDER * half
        M = self.bound_about_rest(middle + radius) if self.start is None and low == 0 else self.bound_on_disc(middle, radius)
        values = [self.inverse_frequency(number(middle + half * Fraction(node, 65536))) for node in NODES]
        rows, largest_product = through_nodes()
        coefficients = [total(mul(row[k], value) for row, value in zip(rows, values)) for k in range(16)]
        rest = Fraction(WIDER, WIDER - 1) * largest_product / (WIDER - 1) ** 16
        return middle, half, coefficients, up(M * rest.numerator, rest.denominator)

    def pieces(self, low, high, spoken):
        """From below on, each as long as it can be had."""
        steps = 1 << 24
        place, width = 0, steps // 4
        while place < steps:
            in_time()
            ends = [low + (high - low) * Fraction(end, steps) for end in (place, min(place + width, steps))]
            try:
                piece = self.piece(*ends)
            except Settled:
                raise
            except NotProved as error:
                width = (min(place + width, steps) - place) // 2
                if width == 0:
                    raise Settled(f"at {spoken(ends[0])} the frequency is not enclosed: {error}")
                continue
            yield piece
            place, width = place + width, 2 * width


class Swing(Family):
    """The same of any f. Of the variable v the turning place b is a function by V(b) = V(a), and m = (a + b)/2."""

    def __init__(self, force, name, start):
        super().__init__(force, name, start)
        self.turn = -1.0                    # b/a, nearly, of the motion before

    def stiffness(self):
        demand(at_zero(self.force) == 0, REST)
        k = super().stiffness()
        demand(k[0] > k[1], "the slope of f at x = 0 is not positive")
        return k

    def turn_nearly(self, v):
        """By Newton's steps for the place b where the integral of f from b to a is zero. No bound depends on how near it is."""
        v = v[0] / ONE
        a, weights = v if self.start is None else float(self.start), weights_of_fejer(48)
        b = a * self.turn
        try:
            force = lambda x: nearly(self.force, {"x": x, self.name: v})
            for _ in range(100):
                m, r, steep = (a + b) / 2, (a - b) / 2, force(b)
                if steep >= 0:              # beyond another place of rest
                    b /= 2
                    continue
                step = r * sum(weight * force(m + r * place) for place, weight in weights) / steep
                b += step
                if abs(step) < 1e-14 * (abs(a) + abs(b)):
                    self.turn = b / a
                    return number(Fraction(round(b * 2.0 ** 70), 1 << 70))
        except (OverflowError, ZeroDivisionError, ValueError):
            pass
        raise NotProved(TURN)

    def series(self, v, b):
        """m, r and f along the motion, where V(b) = V(a) or nearly."""
        a = self.amplitude(v)
        m, r = over(add(a, b), 2), over(add(a, b, -1), 2)
        f = jets(self.force, {"x": ([m, r], [], 0), self.name: ([v], [], 0)}, ())[0]
        demand(not f[1], "sines in a force along cosines")
        return f, r

    def uphill(self, v, b):                 # the integral of f from b to a
        f, r = self.series(v, b)
        return mul(scale(r, 2), over_the_way(f))

    def at_place(self, x, v, by="x"):       # f and its slope
        return pair_at(self.force, {"x": (x, (ONE if by == "x" else 0, 0)), self.name: (v, (ONE if by != "x" else 0, 0))})

    def inverse_frequency(self, v):
        if self.start is None and v == ZERO:
            return root(quotient((ONE, 0), self.stiffness()))
        # By Newton's step on a ball, which has the root in it where the step leads into it.
        b = self.turn_nearly(v)
        off = self.uphill(v, b)
        spread = 2 * size(quotient(off, self.at_place(b, v)[0])) + (ONE >> 150)
        step = quotient(off, self.at_place(enlarged(b, spread), v)[0])
        demand(size(step) < spread, TURN)
        f, r = self.series(v, add(b, step))
        return mean_of_root(divided(rate(f), r))

    def bound_on_disc(self, middle, radius):
        """With b_0 and a_0 of the middle, b -> b + (V(a) - V(b))/f(b_0) maps the disc |b - b_0| <= e into itself and contracts it, for all v
        of the disc: so b is an analytic function of v. V(a) - V(b) changes from the middle by the integrals of f from a_0 to a and from b to
        b_0 and by what the force itself changes on the way. G is the mean of f' on the triangle of a, b and x: at x = b + t (a - b)
        it is 2/t times the integral of u f'(b + u (a - b)) over u < t, and 2/(1 - t) times that of (1 - u) f' over u > t. Where its real
        part is at least R > 0, |1/omega| is no more than R^(-1/2)."""
        if self.start is None:
            try:
                return self.bound_about_rest(middle + radius)
            except Settled:
                raise
            except NotProved:               # too far from rest
                pass
        v, spread = number(middle), reach(radius)
        everywhere, a, b = enlarged(v, spread), self.amplitude(v), self.turn_nearly(v)
        if self.start is None:
            off_a, push = spread, part_of(spread, size(self.at_place(enlarged(a, spread), v)[0]))
        else:
            off_a, changed = 0, sum(size(self.at_place(x, everywhere, self.name)[1]) for x in self.cells(a, 0, b, 0))
            push = up(part_of(spread, part_of(changed, size(add(a, b, -1)))), CELLS)
        push += size(self.uphill(v, b))
        steep = (-self.at_place(b, v)[0][0], 0)
        demand(steep[0] > 0, TURN)
        for quarters in (5, 6, 8, 12):
            off_b = up(quarters * push * ONE, 4 * steep[0]) + (ONE >> 150)
            bent = size(add(self.at_place(enlarged(b, off_b), everywhere)[0], steep))
            if bent < steep[0] and push < part_of(off_b, steep[0] - bent) - 1:
                break
        else:
            raise NotProved(TURN)
        lowest = [at_x[0] - at_x[1] for at_x in (self.at_place(x, everywhere)[1] for x in self.cells(a, off_a, b, off_b))]
        below = least_mean(lowest)
        demand(below > 0, "G is not positive")
        return size(root(quotient((ONE, 0), (below, 0))))

    def cells(self, a, off_a, b, off_b):
        """Balls with all b + t (a - b), t from k/n to (k + 1)/n, of a and b within these distances."""
        way = add(a, b, -1)
        for k in range(CELLS):
            in_time()
            x = add(b, over(scale(way, 2 * k + 1), 2 * CELLS))
            off = max(up((CELLS - j) * off_b + j * off_a, CELLS) for j in (k, k + 1))
            yield enlarged(x, up(size(way), 2 * CELLS) + off)

    def bound_about_rest(self, radius):
        """The same for |a| up to the radius R, on the disc |m| <= R/2, where |x| <= 2 R and |f''| <= B: |S| <= R^2 B/2 at m = 0, the slope of
        S by m is within 4 R B of k = f'(0), and G within 2 R B of it."""
        R, k = reach(radius), self.stiffness()
        B = part_of(R, norm(jets(self.force, {"x": ([(0, 2 * R)], [], 0)}, ("x",))[2][0][0]))
        demand(5 * B < least(k), TURN)
        return size(root(quotient((ONE, 0), (least(k) - 2 * B, 0))))


CELLS = 64                                  # of the way from b to a
TURN, REST = "the place where the motion turns is not enclosed", "f is not seen to be zero at x = 0, where from begins"


def least_mean(lowest):
    """A bound from below, for t from 0 to 1, of 2/t times the integral of u h(u) over u < t and 2/(1 - t) times that of (1 - u) h(u) over
    u > t, of an h that is at least this on each of equal cells."""
    n, halves = len(lowest), []
    for values in (lowest, lowest[::-1]):
        # 2 n^2 times the integral, at the ends of cells, between which it rises or falls.
        sums = [0]
        for k, value in enumerate(values):
            sums.append(sums[-1] + (2 * k + 1) * value)
        # Over n^2 t, where t in the first cell is not bounded from below: there it is h t.
        halves.append([min(0, values[0]) // n] + [min(low // (k + 1), low // k) // n for k in range(1, n) for low in [min(sums[k:k + 2])]])
    return min(map(sum, zip(halves[0], halves[1][::-1])))


def pair_at(tree, letters):                 # a value and its slope, with pairs for letters, whose balls stand for discs too
    kind = tree[0]
    if kind == "number":
        return number(tree[1]), ZERO
    if kind == "letter":
        return letters[tree[1]]
    if kind == "+":
        return tuple(map(total, zip(*(pair_at(part, letters) for part in tree[1]))))
    if kind == "*":
        return functools.reduce(pair_times, (pair_at(part, letters) for part in tree[1]))
    u = pair_at(tree[1], letters)
    if kind == "^":
        return functools.reduce(pair_times, [u] * tree[2], ((ONE, 0), ZERO))
    if kind == "exp":
        value = exponential(u[0])
        return inner(u, value, value)
    s, c = angle(u[0])
    return inner(u, s, c) if kind == "sin" else inner(u, c, scale(s, -1))


def at_zero(tree):                          # the exact value where all letters are zero, if it is seen
    kind = tree[0]
    if kind in ("number", "letter"):
        return tree[1] if kind == "number" else Fraction(0)
    parts = [at_zero(part) for part in (tree[1] if kind in "+*" else [tree[1]])]
    demand(not any(map(long, parts)), REST)
    if kind in "+*":
        return Fraction(sum(parts) if kind == "+" else math.prod(parts))
    if kind == "^":
        return parts[0] ** tree[2]
    demand(parts[0] == 0, REST)
    return Fraction(0 if kind == "sin" else 1)


def nearly(tree, values):                   # in floating point
    kind = tree[0]
    if kind == "number":
        return float(tree[1])
    if kind == "letter":
        return values[tree[1]]
    if kind in "+*":
        return (sum if kind == "+" else math.prod)(nearly(part, values) for part in tree[1])
    inner = nearly(tree[1], values)
    return inner ** tree[2] if kind == "^" else getattr(math, kind)(inner)


@functools.lru_cache(maxsize=None)
def weights_of_fejer(n):                    # places on (-1, 1) with their weights, which add up to 2
    angles = [math.pi * (i + 0.5) / n for i in range(n)]
    weight = lambda t: 2 / n * (1 - 2 * sum(math.cos(2 * j * t) / (4 * j * j - 1) for j in range(1, n // 2 + 1)))
    return [(math.cos(t), weight(t)) for t in angles]


def over_the_way(f):                        # S[f]
    even = total(over(at(f[0], k), k * k - 1) for k in range(2, last(f) + 1, 2))
    return enlarged(add(at(f[0], 0), even, -1), f[2])


def rate(f):                                # L[f]
    c, sums = [ZERO] * max(1, last(f)), [ZERO, ZERO]
    for k in range(last(f), 1, -1):
        sums[k % 2] = add(sums[k % 2], over(at(f[0], k), k * k - 1))
        c[k - 1] = scale(sums[k % 2], 4 * (k - 1))
    c[0] = at(f[0], 1)
    return trimmed(c, [], up(4 * f[2], 3))


def divided(u, by):
    demand(least(by) > 0, "a division by what may be zero")
    return [quotient(a, by) if a != ZERO else ZERO for a in u[0]], [], up(u[2] * ONE, least(by))


@functools.lru_cache(maxsize=None)
def cosines(n):                             # of k (i + 1/2) pi/n, by i and by k
    table = [math.cos(math.pi * i / (2 * n)) for i in range(4 * n)]
    rows = [[table[(2 * i + 1) * k % (4 * n)] for k in range(n)] for i in range(n)]
    return rows, list(zip(*rows))


def inverse_power(G, p, q):
    """A series g, w = 1 - G^p g^q and d >= ||w||, below 1: then G^(-p/q) = g (1 - w)^(-1/q), of a g that is somewhere positive."""
    demand(norm(G) >> P < 1 << 500, "numbers that are too large")
    step = 1 if any(a != ZERO for a in G[0][1::2]) else 2
    rates, n = [m / ONE for m, _ in G[0][::step]], 16
    while True:
        if n >= len(rates):
            rows, columns = cosines(n)
            values = [sum(map(product_of, rates, row)) for row in rows]
            demand(min(values) > 1e-60, "G is not positive")
            values = [value ** (-p / q) for value in values]
            parts = [sum(map(product_of, values, column)) * 2 / n for column in columns]
            parts[0] /= 2
            noise = max(map(abs, parts)) * 4e-16
            if n == 256 or max(map(abs, parts[3 * n // 4:])) < noise:
                break
        n *= 2
        demand(n <= 256, "a force with too many harmonics")
    while abs(parts[-1]) < noise:
        parts.pop()
    c = [ZERO] * (step * len(parts) - step + 1)
    c[::step] = [(int(part * 2.0 ** 80) << P - 80, 0) for part in parts]
    g = c, [], 0
    w = plus(constant(1), times(power_of(G, p), power_of(g, q)), -1)
    d = norm(w)
    demand(d < ONE and total(c)[0] > 0, "G^(-1/2) is not enclosed")
    return g, w, d


def inverse_root(G):
    return inverse_power(G, 1, 2)


def power_of(u, n):                         # of a positive n
    half = power_of(u, n // 2) if n > 1 else None
    return u if n == 1 else times(half, half) if n % 2 == 0 else times(times(half, half), u)


def bound_near(G, p, q, changes):
    """Of |(G + C)^(-p/q)|, p < q, where C is the sum of these series times numbers up to these: no more than |G^(-p/q)|/(1 - |C/G|)."""
    g, _, d = inverse_power(G, p, q)
    h, _, lost = inverse_power(G, 1, 1)
    away = up(sum(part_of(most, norm(times(h, u))) for most, u in changes) * ONE, ONE - lost)
    demand(away < ONE, "G^(-1/2) is not enclosed")
    return up(norm(g) * ONE * ONE, (ONE - d) * (ONE - away))


def bound_of_root(G):                       # of |G^(-1/2)|: ||g|| (1 - d)^(-1/2)
    g, _, d = inverse_root(G)
    return size(quotient((norm(g), 0), root((ONE - d, 0))))


def mean_of_root(G):
    g, w, d = inverse_root(G)
    # G^(-1/2) = g (1 - w)^(-1/2), of which 1 + w/2 leaves less than d^2 + d^3 + ...
    middle = add(mul(at(g[0], 0), at(w[0], 0)), over(total(mul(a, b) for a, b in zip(g[0][1:], w[0][1:])), 2))
    rest = up(part_of(norm(g), w[2]), 2) + up(part_of(norm(g), d) * d, ONE - d)
    return enlarged(add(at(g[0], 0), over(middle, 2)), rest)


@functools.lru_cache(maxsize=None)
def through_nodes():
    """The coefficients of the polynomials of degree 15 that are one at a node and zero at the others, and a bound of the product of the
    distances from all nodes: from the nearest of points 2^-12 apart it grows by at most 2^-13 a factor."""
    rows, nodes = [], [Fraction(node, 65536) for node in NODES]
    for own in nodes:
        row = [Fraction(1)]
        for other in nodes:
            if other != own:
                row = [(below - other * here) / (own - other) for below, here in zip([0] + row, row + [0])]
        rows.append([number(a) for a in row])
    most = max(math.prod(abs(place - node) + 8 for node in NODES) for place in range(-65536, 65537, 16))
    return rows, Fraction(most, 65536 ** 16)


# Functions of a number of a ball, and pairs of a value and its first derivative (None where that has no bound).

def waves_of_number(a):                     # sine and cosine
    demand(abs(a[0]) >> P + 40 == 0, "the argument of sin is too large")
    turns = (a[0] + PI[0]) // (2 * PI[0])
    y, r = a[0] - 2 * turns * PI[0] >> 5, a[1] + 2 * abs(turns) * PI[1] + 32
    w, s, c = y * y >> P, ONE, ONE          # y below 0.1 in size: rounded by less than two units, and 0.1^30/30! is below 2^-206
    for k in range(14, 0, -1):
        s, c = ONE - (w * s >> P) // (2*k*(2*k + 1)), ONE - (w * c >> P) // (2*k*(2*k - 1))
    s = y * s >> P
    for _ in range(5):                      # what is lost grows to less than four times, and four units
        s, c = s * c >> P - 1, ONE - (s * s >> P - 1)
    rest, bent = ONE >> 180, up(part_of(r, r), 2)
    return (s, rest + min(r, part_of(abs(c) + rest, r) + bent)), (c, rest + min(r, part_of(abs(s) + rest, r) + bent))


def exponential(a):
    demand(abs(a[0]) >> P < 600 and a[1] < ONE >> 1, "the argument of exp is too large")
    halvings = 8
    while abs(a[0]) >> halvings - 6 > ONE:
        halvings += 1
    y, result = over((a[0], 0), 1 << halvings), (ONE, 0)    # below 2^-6 in size
    for k in range(24, 0, -1):
        result = add((ONE, 0), over(mul(y, result), k))
    result = enlarged(result, ONE >> 200)   # 2^-150/25! is below 2^-230
    for _ in range(halvings):
        result = mul(result, result)
    return enlarged(result, up(size(result) * a[1], ONE - a[1]))


def logarithm(a):
    demand(least(a) > 0 and a[0] > 0, "a logarithm of what may not be positive")
    y = int((math.log(a[0]) - P * math.log(2)) * 2.0 ** 60) << P - 60
    t = add(mul((a[0], 0), exponential((-y, 0))), (ONE, 0), -1)
    demand(size(t) < ONE >> 40, "a logarithm of what is too small")
    power, result = t, (y, 0)
    for k in range(1, 6):
        result, power = add(result, over(power, k), 1 if k % 2 else -1), mul(power, t)
    return enlarged(result, size(power) + up(a[1] * ONE, a[0] - a[1]))


def inner(u, value, slope):                 # of a function of u with this value and slope
    demand(size(value) >> P < 1 << 1000, "numbers that are too large")
    return value, None if u[1] is None else mul(slope, u[1])


def pair_times(u, v):
    demand(max(size(u[0]), size(v[0])) >> P < 1 << 1000, "numbers that are too large")
    unbounded = u[1] is None or v[1] is None
    return mul(u[0], v[0]), None if unbounded else add(mul(u[1], v[0]), mul(u[0], v[1]))


def pair_power(u, exponent):
    """By products, quotients and roots where those do, else exp(exponent*log(u))."""
    top, bottom = exponent.numerator, exponent.denominator
    if bottom & bottom - 1 == 0 and bottom <= 64 and abs(top) <= 64:
        for _ in range(bottom.bit_length() - 1):
            value = root(u[0])
            u = inner(u, value, quotient((ONE, 0), scale(value, 2)))
        result = (ONE, 0), ZERO
        for bit in bin(abs(top))[2:]:
            result = pair_times(result, result)
            if bit == "1":
                result = pair_times(result, u)
        if top < 0:
            value = quotient((ONE, 0), result[0])
            return inner(result, value, scale(mul(value, value), -1))
        return result
    factor = number(exponent)
    value = exponential(mul(factor, logarithm(u[0])))
    return inner(u, value, mul(factor, quotient(value, u[0])))


# A law as a power of r times such a pair: of r = 1/v an interval may reach zero.

class Interval:
    def __init__(self, low, high, is_far):
        middle = (low + high) / 2
        self.low, self.high, self.is_far = low, high, is_far
        self.ball = enlarged(number(middle), reach((high - low) / 2))
        self.slope = (ONE, 0) if low < high else None   # no one asks for it at a place

    def letter(self, name):
        return self.ball, self.slope

    def power(self, exponent):              # of r, with its slope
        if exponent == 0:
            return (ONE, 0), ZERO
        if self.low > 0 or exponent.denominator == 1:
            return pair_power((self.ball, self.slope), exponent)
        demand(exponent > 0, "a division by what may be zero")
        half = up(size(pair_power((number(self.high), None), exponent)[0]), 2) if self.high else 0
        return (half, half), None

    def with_power(self, term, power):
        return power, term[1] if term[0] == power else pair_times(term[1], self.power(term[0] - power))


def steps_of(tree):
    """A law as steps, each from the results of those before, in which equal parts are one."""
    steps, places = [], {}

    def put(tree):
        key, kind = repr(tree), tree[0]
        if key not in places:
            if kind in ("number", "pi", "letter"):
                step = (kind, number(tree[1]) if kind == "number" else tree[-1])
            else:
                step = (kind, [put(part) for part in tree[1]] if kind in "+*" else put(tree[1]), *tree[2:])
            places[key] = len(steps)
            steps.append(step)
        return places[key]

    put(tree)
    return steps


def law_on(law, interval):
    known, none = [], Fraction(0)
    for step in law:
        known.append(step_on(step, known, interval, none))
    return known[-1]


def step_on(step, known, interval, none):
    kind = step[0]
    if kind in ("number", "pi"):
        return none, (PI if kind == "pi" else step[1], ZERO)
    if kind == "letter":
        return (Fraction(-1), ((ONE, 0), ZERO)) if interval.is_far else (none, interval.letter(step[1]))
    if kind == "+":
        terms = [known[part] for part in step[1]]
        if interval.is_far:
            terms = [term for term in terms if term[1] != (ZERO, ZERO)] or terms[:1]
            power = min(term[0] for term in terms)
            terms = [interval.with_power(term, power) for term in terms]
        unbounded = any(slope is None for _, (_, slope) in terms)
        return terms[0][0], (total(u[0] for _, u in terms), None if unbounded else total(u[1] for _, u in terms))
    if kind == "*":
        power, product = known[step[1][0]]
        for part in step[1][1:]:
            power, product = power + known[part][0] if interval.is_far else none, pair_times(product, known[part][1])
        return power, product
    power, u = known[step[1]]
    if kind == "^":
        return power * step[2] if power else none, pair_power(u, step[2])
    u = interval.with_power((power, u), none)[1]
    if kind in ("sin", "cos"):
        s, c = waves_of_number(u[0])
        return none, inner(u, s, c) if kind == "sin" else inner(u, c, scale(s, -1))
    if kind == "exp":
        value = exponential(u[0])
        return none, inner(u, value, value)
    return none, inner(u, logarithm(u[0]), quotient((ONE, 0), u[0]))


def over_truth(law, interval, inverse_frequency, n, growth):
    """law/truth, where the truth is omega^n and 1/omega is r^(growth/2) times this pair; of a contact T/T_0 is in the place of 1/omega."""
    power, u = law_on(law, interval)
    u = pair_times(u, pair_power(inverse_frequency, Fraction(n)))
    power += Fraction(growth * n, 2)
    if power < 0 and interval.low == 0 and interval.is_far:
        raise Settled("the law and the true frequency grow with different powers, so that no error bounds it to infinity")
    return interval.with_power((power, u), Fraction(0))[1]


def on_polynomial(coefficients, per_half, e, with_slope=True):   # its value, and its slope by the variable
    value, slope = ZERO, ZERO
    for a in reversed(coefficients):
        if with_slope:
            slope = add(mul(slope, e), value)
        value = add(mul(value, e), a)
    return value, mul(slope, per_half) if with_slope else None


def largest_on(piece, law, n, growth, interval, most, spoken):
    """A bound of |law/truth - 1| on a piece, in parts on which it is at most this."""
    middle, half, coefficients, remainder = piece
    per_half, found, parts = number(1 / half), 0, [(Fraction(-1), Fraction(1), 0)]
    while parts:
        in_time()
        low, high, depth = parts.pop()
        e, spread = number((low + high) / 2), reach((high - low) / 2)
        ends = middle + half * low, middle + half * high
        place = sum(ends) / 2
        why = "the error is not proved to be within its bound"
        try:
            truth = on_polynomial(coefficients, per_half, enlarged(e, spread))
            # The polynomial stands for the truth up to this relative error.
            demand(least(truth[0]) > 0, "a frequency that may be infinite")
            off = pair_power(((ONE, up(remainder * ONE, least(truth[0]))), None), Fraction(n))[0]
            there = over_truth(law, interval(place, place), on_polynomial(coefficients, per_half, e, False), n, growth)[0]
            if least(add(mul(there, off), (ONE, 0), -1)) > most:
                raise Settled(f"at {spoken(place)} the error is above its bound")
            q, slope = over_truth(law, interval(*ends), truth, n, growth)
            if slope is not None:
                by_slope = enlarged(there, part_of(part_of(spread, reach(half)), size(slope)))
                q = min(q, by_slope, key=lambda ball: ball[1])
            error = size(add(mul(q, off), (ONE, 0), -1))
            if error <= most:
                found = max(found, error)
                continue
        except Settled:
            raise
        except NotProved as error:
            why = f"the law is not enclosed: {error}"
        if depth == 40:
            raise Settled(f"at {spoken(place)} {why}")
        parts += [((low + high) / 2, high, depth + 1), (low, (low + high) / 2, depth + 1)]
    return found


def in_reciprocal(force, name):
    """f(x, 1/r) r^d, a polynomial in r, where d is the degree of f in v."""
    terms, atoms = expanded(force, True), {}

    def look(tree):
        if tree[0] in ("sin", "cos", "exp"):
            atoms[repr(tree)] = tree
            demand(not has_letter(tree, name), f"a {tree[0]} of a parameter that goes to infinity")
        elif tree[0] not in ("number", "letter"):
            for part in tree[1] if tree[0] in "+*" else [tree[1]]:
                look(part)

    look(force)
    demand(terms, "a force that this program does not know")
    degree = max(dict(monomial).get(name, 0) for monomial in terms)
    demand(degree <= MOST_GROWTH, f"a force of a degree above {MOST_GROWTH} in a parameter that goes to infinity")
    parts = []
    for monomial, value in terms.items():
        powers = dict(monomial)
        powers[name] = degree - powers.get(name, 0)
        parts.append(("*", [("number", value)] + [("^", atoms.get(letter, ("letter", letter)), n) for letter, n in powers.items() if n]))
    return ("+", parts), degree


def has_letter(tree, name):
    if tree[0] in ("number", "letter"):
        return tree == ("letter", name)
    return any(has_letter(part, name) for part in (tree[1] if tree[0] in "+*" else [tree[1]]))


# The duration of a contact x'' = -k x^n (1 + c x') from x = 0 with x' = v until x = 0 again. With y = log(1 + c x') it is
# exp(y) - 1 - y + c^2 k x^(n+1)/(n + 1) = V(a), and dt = -dy/(c k x^n): the y of a swing of the force exp(y) - 1 from a = log(1 + c v) to
# b = log(1 - e c v), e the restitution. With nu = n/(n + 1) and s = 1 - 2 nu, T is a number times c^-s r^s times the integral of
# sin^s(theta) G^(-nu), and at c = 0, where G = 1 and r is c v, T_0 is the same number times v^s times the integral of sin^s:
# T/T_0 = (r/(c v))^s mean_s(G^(-nu)), with the weight sin^s in the mean. The middle of the swing is log(r/sinh(r)). So with z = 2 r
# a = log(z/(1 - exp(-z))), b = log(z/(exp(z) - 1)), c v = z p/q, e = w/p, r/(c v) = q/(2 p), and G = K r/sinh(r), where
# q = (exp(z) - 1)/z = sum z^k/(k + 1)!, p = q' = sum (k + 1) z^k/(k + 2)!, w = (q - 1)/z = sum z^k/(k + 2)!, sinh(r)/r = q exp(-r) and
# K = L[exp(r cos(theta))]/r. p, q, w and the coefficients of K are power series with positive coefficients: within rho of a point r >= 0
# of the complex plane none of them is farther from what it is there than what it is at r + rho. With r from 0 on v grows, as
# z/(1 - exp(-z)) does.

LONGEST_EXPONENT = 24                       # of n = a/b the largest a + b
HARDEST = 100                               # the largest c v


class Contact(Family):
    """The contacts with c x' and the power n, of the variable r."""

    def __init__(self, n, c, name):
        self.c, self.name, self.start = c, name, "touch"
        self.top, self.bottom, self.s = n.numerator, n.numerator + n.denominator, (1 - n) / (1 + n)

    def shape(self, r):
        """K and r times its slope by r. exp(r cos(theta)) has the cosines F_k = 2 I_k(r), F_k/r = sum_j (r/2)^(2 j + k - 1)/(j! (j + k)!), and its harmonics beyond
        some k are no more in the norm than its powers of r beyond that."""
        square, first, beyond = over(mul(r, r), 4), (ONE, 0), ONE
        c, slopes, k = [ZERO], [ZERO], 1
        while True:                         # first is (r/2)^(k-1)/k!, beyond r^(k-1)/k!
            term, sum_of_terms, slope, j = first, first, scale(first, k - 1), 1
            while True:
                term = over(mul(term, square), j * (j + k))
                sum_of_terms, slope = add(sum_of_terms, term), add(slope, scale(term, 2 * j + k - 1))
                if 4 * size(square) < (j + 1) * (j + 1 + k) * ONE and size(term) < ONE >> 200:
                    break                   # each that follows, with its factor, is less than half of the one before
                j += 1
            c.append(enlarged(sum_of_terms, size(term)))
            slopes.append(enlarged(slope, (2 * j + k - 1) * size(term)))
            k += 1
            first, beyond = over(mul(first, over(r, 2)), k), up(part_of(beyond, size(r)), k)
            if 4 * size(r) < (k + 1) * ONE and beyond < ONE >> 100:
                return rate((c, [], 2 * beyond)), rate((slopes, [], 2 * k * beyond))

    def inverse_frequency(self, r):
        """T/T_0 of r."""
        p, _, q, _, _ = around_rest(scale(r, 2))
        g, w, d = inverse_power(divided(self.shape(r)[0], mul(q, exponential(scale(r, -1)))), self.top, self.bottom)
        rest = up(part_of(norm(g), d) * d, ONE - d)
        mean_of_power = enlarged(add(self.mean(g), over(self.mean(times(g, w)), self.bottom)), rest)
        return mul(pair_power((quotient(q, scale(p, 2)), None), self.s)[0], mean_of_power)

    def mean(self, u):
        """With the weight sin^s cos(k theta) has M_0 = 1, M_1 = 0 and M_(k+2) = M_k (k - s)/(k + 2 + s), by the derivative of
        sin^(s+1) cos((k+1) theta)."""
        weight, result = (ONE, 0), ZERO
        for k in range(0, last(u) + 1, 2):
            result = add(result, mul(weight, at(u[0], k)))
            top, bottom = k - self.s, k + 2 + self.s
            weight = over(scale(weight, top.numerator * bottom.denominator), bottom.numerator * top.denominator)
        return enlarged(result, u[2])

    def bound_on_disc(self, middle, radius):
        here, there, spread = number(middle), number(middle + radius), reach(radius)
        at_here, at_there = around_rest(scale(here, 2)), around_rest(scale(there, 2))
        per = (mul(at_here[2], exponential(scale(here, -1)))[0], 0)     # sinh(r)/r here, or nearly: G is K over that
        K, slope, K_there = (divided(u, per) for u in (*self.shape(here), self.shape(there)[0]))
        slope = divided(slope, here)
        rest = plus(plus(K_there, K, -1), times(slope, ([(spread, 0)], [], 0)), -1)
        bound = bound_near(K, self.top, self.bottom, [(spread, slope), (norm(rest), constant(1))])
        p, _, q, _, _ = (enlarged(a, size(add(b, a, -1))) for a, b in zip(at_here, at_there))
        p = scale(p, 2)
        demand(least(p) > 0 and least(q) > 0, "the speed may be zero or infinite")     # and a root of them is taken
        width = pair_power(((size(quotient(q, p) if self.s > 0 else quotient(p, q)), 0), None), abs(self.s))[0]
        factor = up(part_of(size(q), size(exponential(enlarged(scale(here, -1), spread)))) * ONE, least(per))
        return size(mul(mul(width, pair_power(((factor, 0), None), Fraction(self.top, self.bottom))[0]), (bound, 0)))

    def letters(self, low, high):
        """v and e between these r: by the values at the ends, or by those in the middle and the slopes, whichever is narrower."""
        known = [hull(*parts) for parts in zip(*(around_rest(number(2 * r)) for r in (low, high)))]
        v, e, slopes = self.speed_and_restitution(hull(number(2 * low), number(2 * high)), *known)
        if low == high:
            return {self.name: (v, None), "e": (e, None)}
        middle, half = low + high, reach((high - low) / 2)
        at_middle = self.speed_and_restitution(number(middle), *around_rest(number(middle)))[:2]
        slopes = [scale(slope, 2) for slope in slopes]
        balls = [min(ball, enlarged(there, part_of(half, size(slope))), key=lambda ball: ball[1])
                 for ball, there, slope in zip((v, e), at_middle, slopes)]
        return {self.name: (balls[0], slopes[0]), "e": (balls[1], slopes[1])}

    def speed(self, r):                     # for a sentence
        z = number(2 * r)
        return Fraction(self.speed_and_restitution(z, *around_rest(z))[0][0], ONE)

    def speed_and_restitution(self, z, p, dp, q, w, dw):   # and their slopes by z
        per_c = number(1 / self.c)
        speed, e = quotient(p, q), quotient(w, p)
        slope = add(speed, mul(z, add(quotient(dp, q), mul(speed, speed), -1)))
        return mul(mul(z, speed), per_c), e, (mul(slope, per_c), quotient(add(dw, mul(e, dp), -1), p))

    def place(self, v):
        """Two r that have this v between them, the second of no smaller v."""
        low, high = 0, reach(self.c * v)    # c v >= z/2
        speed_at = lambda r: self.speed_and_restitution((2 * r, 0), *around_rest((2 * r, 0)))[0]
        while high - low > ONE >> 150:
            middle = (low + high) // 2
            speed, wanted = speed_at(middle), number(v)
            if speed[0] + speed[1] <= wanted[0]:
                low = middle
            elif speed[0] - speed[1] >= sum(wanted):
                high = middle
            else:
                break
        return Fraction(low, ONE), Fraction(high, ONE)


class Touch(Interval):
    """A part of the r of contacts, or a place, with the letters of a law there."""

    def __init__(self, low, high, letters):
        super().__init__(low, high, False)
        self.letters = letters

    def letter(self, name):
        return self.letters[name]


def hull(a, b):                             # of two balls of the real line
    low, high = min(a[0] - a[1], b[0] - b[1]), max(a[0] + a[1], b[0] + b[1])
    return (low + high) // 2, up(high - low, 2) + 1


@functools.lru_cache(maxsize=4096)
def around_rest(z):                         # p, p', q, w, w' of a z that is not negative, by z^k/(k + 3)!
    term, sums, k = over((ONE, 0), 6), [ZERO] * 5, 0
    while True:
        for place, factor in enumerate(((k + 1) * (k + 3), (k + 1) * (k + 2), (k + 2) * (k + 3), k + 3, k + 1)):
            sums[place] = add(sums[place], scale(term, factor))
        if 4 * size(z) < (k + 4) * ONE and size(term) < ONE >> 230:
            break                           # each that follows, with its factor, is less than half of the one before
        k += 1
        term = over(mul(term, z), k + 3)
    return tuple(enlarged(a, 2 * (k + 3) ** 2 * size(term)) for a in sums)


def contact_of(text):
    """n and c of k x^n (1 + c x'), as a sum of k x^n and k c x^n x'."""
    def terms_of(tree):                     # coefficients by the powers of x and of x'
        kind = tree[0]
        if kind == "number":
            return {(Fraction(0), 0): tree[1]}
        if kind == "letter":
            return {(Fraction(1), 0) if tree[1] == "x" else (Fraction(0), 1): Fraction(1)}
        if kind == "+":
            result = {}
            for part in tree[1]:
                for powers, value in terms_of(part).items():
                    result[powers] = result.get(powers, 0) + value
        elif kind == "*":
            result = {(Fraction(0), 0): Fraction(1)}
            for part in tree[1]:
                product = {}
                for one, value in result.items():
                    for other, factor in terms_of(part).items():
                        powers = one[0] + other[0], one[1] + other[1]
                        product[powers] = product.get(powers, 0) + value * factor
                result = product
                demand(len(result) <= 50 and not any(map(long, result.values())), unknown)
        else:
            demand(kind == "^", unknown)
            base = terms_of(tree[1])
            demand(base in ({(Fraction(1), 0): 1}, {(Fraction(0), 1): 1}) or tree[2] in (1, -1) and len(base) == 1, unknown)
            (powers, value), = base.items()
            demand(value != 0 and (powers[1] * tree[2]).denominator == 1, unknown)
            result = {(powers[0] * tree[2], int(powers[1] * tree[2])): value if tree[2] > 0 else 1 / value}
        return {powers: value for powers, value in result.items() if value}

    unknown = "f is not seen to be k*x^n*(1 + c*x')"
    try:
        terms = terms_of(parse(text, {"x", "x'"}, True))
    except NotProved as error:
        raise NotProved(unknown if str(error) == unknown else f"{unknown}: {error}")
    demand(len(terms) == 2 and sorted(power for _, power in terms) == [0, 1] and len({n for n, _ in terms}) == 1, unknown)
    n = min(terms)[0]
    k, c = terms[n, 0], terms[n, 1] / terms[n, 0]
    demand(k > 0 and c > 0 and n > 0, "f is k*x^n*(1 + c*x') with a k, n or c that is not positive")
    demand(n.numerator + n.denominator <= LONGEST_EXPONENT, f"a power n of x in f whose numerator and denominator are together above {LONGEST_EXPONENT}")
    return n, c


# Sheets (rows, tail): the functions sum c_kn cos(k theta) cos(n phi) + h of two angles, rows[k][n] = c_kn in units of 2^-Q, where |h| in the
# norm by theta is at most tail for each phi.

Q = 80


def sheet_of(ball):
    return [[ball[0] >> P - Q]], up(ball[1], 1 << P - Q) + 1


def sheet_plus(u, v, sign=1):
    join = lambda a, b: [m + sign * n for m, n in itertools.zip_longest(a, b, fillvalue=0)]
    return cleared([join(a, b) for a, b in itertools.zip_longest(u[0], v[0], fillvalue=[])], u[1] + v[1])


def cleared(rows, tail):                    # what is negligible is a part of the tail
    negligible = 1 << 14
    tail += sum(abs(m) for row in rows for m in row if abs(m) < negligible)
    rows = [[m if abs(m) >= negligible else 0 for m in row] for row in rows]
    for part in rows + [rows]:
        while part and not part[-1]:
            part.pop()
    return rows, tail


def sheet_finite(u):
    return sum(abs(m) for row in u[0] for m in row)


def sheet_norm(u):
    return sheet_finite(u) + u[1]


def sheet_shrunk(u, n):                     # by a positive integer
    rows = [[m // n for m in row] for row in u[0]]
    return cleared(rows, up(u[1], n) + sum(map(len, rows)))


def sheet_times(u, v):
    """Of polynomials in exp(i theta) and exp(i phi), all coefficients of each in one integer."""
    in_time()
    tail = up(u[1] * sheet_norm(v) + v[1] * sheet_finite(u), 1 << Q)
    if not u[0] or not v[0]:
        return [], tail
    heights, widths = [len(f[0]) - 1 for f in (u, v)], [max(map(len, f[0])) - 1 for f in (u, v)]
    # Where all harmonics are odd or all are even, every other one.
    is_sparse = all(not row or (height - k) % 2 == 0 for f, height in zip((u, v), heights) for k, row in enumerate(f[0]))
    height, step, width = sum(heights), 2 if is_sparse else 1, 2 * sum(widths) + 1
    most = math.prod(max(map(abs, itertools.chain(*f[0]))) for f in (u, v))
    octets = (most.bit_length() + ((2 * height + 1) * width).bit_length() + 6) // 8 + 1

    def packed(f, own):
        numbers = []
        for k in range(-own, own + 1, step):
            row = [m * (1 if k else 2) * (1 if n else 2) for n, m in enumerate(f[0][abs(k)])]
            row += [0] * ((width + 1) // 2 - len(row))
            numbers += row[:0:-1] + row
        signed = lambda sign: int.from_bytes(b"".join(max(0, sign * m).to_bytes(octets, "little") for m in numbers), "little")
        return signed(1) - signed(-1)

    # A row of the product is twice as wide as its entries, whose places those of the next ones do not reach.
    count, half = (2 * height // step + 2) * width, 1 << 8 * octets - 1
    shifted = packed(u, heights[0]) * packed(v, heights[1]) + int.from_bytes(half.to_bytes(octets, "little") * count, "little")
    text, rows = shifted.to_bytes(octets * count + 1, "little"), []
    for k in range(height + 1):
        places = range((height + k) // step * width + width - 1, (height + k) // step * width + width + sum(widths))
        numbers = [int.from_bytes(text[octets * place:octets * (place + 1)], "little") - half for place in places] if (height - k) % step == 0 else []
        rows.append([m >> Q + 4 - (k > 0) - (n > 0) for n, m in enumerate(numbers)])
    return cleared(rows, tail + sum(map(len, rows)))


def sheet_without_constant(u):
    if not u[0] or not u[0][0]:
        return ZERO, u
    return (u[0][0][0] << P - Q, 0), ([[0] + u[0][0][1:]] + u[0][1:], u[1])


SHEETS = Operations(1 << Q, sheet_of, sheet_plus, sheet_times, sheet_shrunk, lambda u, r: (u[0], u[1] + r), sheet_norm, sheet_without_constant)


def on_sheet(tree, letters, known):         # equal parts are one
    key, kind, by = repr(tree), tree[0], SHEETS
    if key in known:
        return known[key]
    if kind in ("number", "letter"):
        value = letters[tree[1]] if kind == "letter" else sheet_of(number(tree[1]))
    elif kind in "+*":
        value = functools.reduce(by.plus if kind == "+" else by.times, (on_sheet(part, letters, known) for part in tree[1]))
    elif kind == "^":
        base, value = on_sheet(tree[1], letters, known), sheet_of((ONE, 0))
        for bit in bin(tree[2])[2:]:
            value = by.times(value, value)
            value = by.times(value, base) if bit == "1" else value
    elif kind == "exp":
        value = exponential_of(on_sheet(tree[1], letters, known), by)
    else:
        value = sine_and_cosine(on_sheet(tree[1], letters, known), by)[kind == "cos"]
    known[key] = value
    return value


# Normal modes q = a v: v'' + mu f(a v)/a = 0 on pieces of the range of amplitudes.

def by_degrees(tree, names):
    """Of a polynomial its homogeneous parts, by their degrees, with differences as they stand; None of other functions."""
    kind = tree[0]
    if kind in ("number", "letter"):
        return {1 if kind == "letter" and tree[1] in names else 0: tree}
    if kind not in "+*^":
        return None
    parts = [by_degrees(part, names) for part in tree[1]] if kind in "+*" else [by_degrees(tree[1], names)]
    if None in parts:
        return None
    if kind == "+":
        degrees = sorted({degree for part in parts for degree in part})
        return {degree: ("+", [part[degree] for part in parts if degree in part]) for degree in degrees}
    if kind == "^":
        if len(parts[0]) == 1:
            return {degree * tree[2]: ("^", part, tree[2]) for degree, part in parts[0].items()}
        parts *= tree[2]
    product = {0: ("number", Fraction(1))}
    for part in parts:
        demand(len(product) * len(part) <= 400, "a force that is written with too many sums in products")
        terms = {}
        for (m, one), (n, other) in itertools.product(product.items(), part.items()):
            terms.setdefault(m + n, []).append(("*", [one, other]))
        product = {degree: ("+", some) if len(some) > 1 else some[0] for degree, some in terms.items()}
    return product


def over_amplitude(force, names, a, reciprocal):
    """f(a v)/a: of a polynomial without the reciprocal."""
    degrees = by_degrees(force, names)
    if degrees is None:
        scaled = lambda tree: (tree[0], *(list(map(scaled, part)) if isinstance(part, list) else scaled(part) if isinstance(part, tuple) else part
                                          for part in tree[1:])) if tree[0] != "letter" else ("*", [("letter", a), tree])
        return ("*", [("letter", reciprocal), scaled(force)])
    return ("+", [("*", [("^", ("letter", a), degree - 1), part]) for degree, part in degrees.items() if degree])


def sampled(tree, lists, count):            # in floating point
    kind = tree[0]
    if kind == "number":
        return [float(tree[1])] * count
    if kind == "letter":
        return lists[tree[1]]
    if kind in "+*":
        parts = [sampled(part, lists, count) for part in tree[1]]
        return list(map(sum, zip(*parts))) if kind == "+" else list(map(math.prod, zip(*parts)))
    inner = sampled(tree[1], lists, count)
    return [x ** tree[2] for x in inner] if kind == "^" else list(map(getattr(math, kind), inner))


def inverse_nearly(rows):                   # by elimination with the largest pivot, in floating point
    n = len(rows)
    rows = [list(row) + [float(i == j) for j in range(n)] for i, row in enumerate(rows)]
    for k in range(n):
        in_time()
        best = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[best] = rows[best], rows[k]
        demand(rows[k][k] != 0, "a derivative without an inverse")
        own = rows[k] = [x / rows[k][k] for x in rows[k]]
        for i, row in enumerate(rows):
            if i != k and row[k]:
                factor = row[k]
                rows[i] = [x - factor * y for x, y in zip(row, own)]
    return [row[n:] for row in rows]


class ModeNearly:
    """Newton's steps for mu and the harmonics of v up to the last one, in floating point. No bound depends on them."""

    def __init__(self, forces, names, a, reciprocal, condition, odd, last):
        self.forces, self.names, self.a, self.reciprocal, self.condition = forces, names, a, reciprocal, condition
        self.slopes = [[slope(force, name) for name in names] for force in forces]
        self.last, self.step, self.first = last, 2 if odd else 1, 1 if odd else 0
        self.harmonics = range(self.first, last + 1, self.step)
        self.waves = [(i, k) for i in range(len(names)) for k in self.harmonics]
        self.samples = last + 1 if odd else 2 * (last + 1)
        angles = [(math.pi / 2 if odd else math.pi) * (j + 0.5) / self.samples for j in range(self.samples)]
        self.cosines = [[math.cos(k * angle) for angle in angles] for k in range(2 * last + 1)]
        self.inverse = None

    def letters(self, u, v):
        n, lists = len(self.harmonics), {self.a: [v] * self.samples, self.reciprocal: [1 / v if v else 0.0] * self.samples}
        by_angle = list(zip(*(self.cosines[k] for k in self.harmonics)))
        for i, name in enumerate(self.names):
            own = u[1 + i * n:1 + (i + 1) * n]
            lists[name] = [sum(map(product_of, own, waves)) for waves in by_angle]
        return lists

    def harmonic(self, values, k):
        return sum(map(product_of, values, self.cosines[k])) * (2 if k else 1) / self.samples

    def conditioned(self, wave):            # the derivative of the condition
        i, k = wave
        return float(self.condition == i) if isinstance(self.condition, int) else float(Fraction(self.condition[i][0], ONE)) if k == 1 else 0.0

    def left(self, u, v):
        forces = [sampled(force, self.letters(u, v), self.samples) for force in self.forces]
        off = sum(self.conditioned(wave) * c for wave, c in zip(self.waves, u[1:])) - 1
        return [off] + [u[0] * self.harmonic(forces[i], k) - k * k * c for (i, k), c in zip(self.waves, u[1:])]

    def derivative(self, u, v, last):       # on the harmonics up to a last one, and the largest sum of norms of slopes
        lists, waves = self.letters(u, v), [(i, k) for i, k in self.waves if k <= last]
        forces = [sampled(force, lists, self.samples) for force in self.forces]
        halves = [[[self.harmonic(values, k) / (2 if k else 1) for k in range(2 * last + 1)] for values in (sampled(s, lists, self.samples) for s in row)]
                  for row in self.slopes]
        entry = lambda h, k, m: (2 if k else 1) * h[k] if m == 0 else h[m] if k == 0 else h[abs(k - m)] + h[k + m]
        rows = [[0.0] + [self.conditioned(wave) for wave in waves]]
        for i, k in waves:
            rows.append([self.harmonic(forces[i], k)] + [u[0] * entry(halves[i][j], k, m) - (k * k if (i, k) == (j, m) else 0) for j, m in waves])
        places = range(len(self.names))
        return rows, max(sum(2 * sum(map(abs, halves[i][j])) for i in places) for j in places)

    def solved(self, u, v):
        before = math.inf
        for _ in range(40):
            left = self.left(u, v)
            if self.inverse is None:
                self.inverse = inverse_nearly(self.derivative(u, v, self.last)[0])
            step = [sum(map(product_of, row, left)) for row in self.inverse]
            size = sum(map(abs, step))
            if size > before / 4 and size > 1e-11:
                self.inverse = None if before < math.inf else self.inverse
            if not size < 1e3 or size >= before and size < 1e-11:
                break
            u, before = [x - y for x, y in zip(u, step)], size
            if size < 1e-15:
                break
        demand(before < 1e-11, "no motion is found")
        return u


class ModeBranch:
    """The motions of a mode, one for each amplitude of a range.

    On a piece v = middle + half cos(phi) let z(phi) be an approximation, of mu and v, and z_0 its mean. Z1 and Z2 are those of Swings about z_0,
    for all amplitudes of the piece. If Z = Z1 + Z2 R < 1, 1 - B F contracts on the ball of radius R about z_0, which holds one motion at most,
    and holds it within s = max ||B F(z)||/(1 - Z) of z where all that is near z is in the ball. At its end each piece has the motion of the
    next one in its ball, and the first one all that is near to the numbers of the file."""

    def __init__(self, forces, names, name, condition, odd, low, mu, lists):
        self.names, self.name, self.condition, self.odd, self.reciprocal = names, name, condition, odd, "1/" + name
        self.forces = [over_amplitude(force, names, name, self.reciprocal) for force in forces]
        self.is_polynomial = all(by_degrees(force, names) is not None for force in forces)
        self.named, self.end, self.last = (number(mu), [list(map(number, c)) for c in lists]), None, 0
        self.waves = [(i, k) for i, c in enumerate(lists) for k in range(len(c))]
        self.known = [(float(low), [float(mu)] + [float(a) for c in lists for a in c])]    # motions at places before, nearly
        self.fit(max([7] + [len(c) - 1 | 1 for c in lists]))

    def fit(self, last):                    # to harmonics up to this one
        demand(last <= 63, "motions with more than 63 harmonics")
        self.nearly = ModeNearly(self.forces, self.names, self.name, self.reciprocal, self.condition, self.odd, last)
        put = lambda u: [u[0]] + [dict(zip(self.waves, u[1:])).get(wave, 0.0) for wave in self.nearly.waves]
        self.known, self.waves, self.last = [(v, put(u)) for v, u in self.known], self.nearly.waves, last

    def solved(self, known, v):             # from what the last motions lead to
        last = known[-3:]
        weight = lambda own: math.prod((v - other) / (own - other) for other, _ in last if other != own)
        return self.nearly.solved([sum(terms) for terms in zip(*([weight(own) * a for a in u] for own, u in last))], v)

    def approximate(self, middle, half):
        """mu, the harmonics of all coordinates, and the root of mu, as sheets."""
        angles = [math.pi * (j + 0.5) / PLACES for j in range(PLACES)]
        while True:
            known = list(self.known)
            for angle in reversed(angles):
                v = float(middle) + float(half) * math.cos(angle)
                known.append((v, self.solved(known, v)))
            found = [u for _, u in known[:-PLACES - 1:-1]]
            if all(abs(c) < 1e-13 for u in found for (_, k), c in zip(self.waves, u[1:]) if k > self.last - self.nearly.step):
                break
            self.fit(self.last + 8)

        def series(values):                 # by cos(n phi)
            coefficients = (sum(a * math.cos(n * angle) for a, angle in zip(values, angles)) * (2 if n else 1) / PLACES for n in range(PLACES))
            return [round(c * 2.0 ** 60) << Q - 60 for c in coefficients]

        rows = [series(values) for values in zip(*found)]
        demand(min(u[0] for u in found) > 0, "a frequency without a value")
        harmonics = [[[] for _ in range(self.last + 1)] for _ in self.names]
        for (i, k), row in zip(self.waves, rows[1:]):
            harmonics[i][k] = row
        exactly = lambda rows: (cleared(rows, 0)[0], 0)
        return exactly([rows[0]]), [exactly(own) for own in harmonics], exactly([series([math.sqrt(u[0]) for u in found])]), known

    def swings(self, middle, half, mu, X):
        """About the means of mu and X, for all amplitudes of the piece."""
        mean = lambda row: row[0] if row else 0
        mu, X = mean(mu[0][0]) << P - Q, [[(mean(row) << P - Q, 0) for row in u[0]] for u in X]
        u, v = [mu / ONE] + [at(X[i], k)[0] / ONE for i, k in self.waves], float(middle)
        rows, stiffness = self.nearly.derivative(u, v, self.last)
        N = min(max(3, math.ceil(math.sqrt(10 * u[0] * stiffness))) | 1, self.last)
        kept = [0] + [1 + n for n, (_, k) in enumerate(self.waves) if k <= N]
        inverse = inverse_nearly([[rows[n][m] for m in kept] for n in kept])
        sigma = Fraction(2) ** max(-20, min(20, round(-math.log2(u[0]))))
        B = Block([[round(a * 2.0 ** 60) for a in row] for row in inverse], 60, sigma)
        ball = enlarged(number(middle), reach(half))
        others = {self.name: ([ball], [], 0)}
        if not self.is_polynomial:
            others[self.reciprocal] = [quotient((ONE, 0), ball)], [], 0
        harmonics = [k for k in self.nearly.harmonics if k <= N]
        return Swings(self.forces, self.names, self.condition, B, harmonics, self.odd, (mu, 0), [trimmed(c, [], 0) for c in X], others)

    def defect(self, swings, middle, half, mu, X):
        c, h, way = number(middle), number(half), ([[0, 1 << Q]], 0)
        letters = {**dict(zip(self.names, X)), self.name: sheet_plus(sheet_of(c), sheet_times(sheet_of(h), way))}
        if not self.is_polynomial:
            # 1/(c + h cos(phi)) = (1 + 2 sum (-rho)^n cos(n phi))/q, q^2 = c^2 - h^2, rho = (c - q)/h.
            q = root(add(mul(c, c), mul(h, h), -1))
            term, rho, reciprocal, n = quotient((ONE, 0), q), quotient(add(c, q, -1), h), ([], 0), 0
            while size(term) << 72 > ONE:
                in_time()
                own = sheet_of(scale(term, 2 if n else 1))
                reciprocal, term, n = sheet_plus(reciprocal, ([[0] * n + own[0][0]], own[1])), scale(mul(term, rho), -1), n + 1
            left = up(2 * size(term) * ONE, ONE - size(rho))
            letters[self.reciprocal] = reciprocal[0], reciprocal[1] + up(left, 1 << P - Q)
        known = {}
        bent = [sheet_times(mu, on_sheet(force, letters, known)) for force in self.forces]
        entry = lambda u, k, n: ((u[0][k][n] << P - Q) if k < len(u[0]) and n < len(u[0][k]) else 0, 0)
        end, Y = max(len(u[0]) for u in X + bent), 0
        for n in range(max(len(row) for u in X + bent for row in u[0])):
            condition = swings.conditioned([[entry(u, k, n) for k in range(len(u[0]))] for u in X])
            Y += swings.turned(add(condition, (0 if n else ONE, 0), -1), lambda i, k: add(entry(bent[i], k, n), scale(entry(X[i], k, n), -k * k)), end)
        return Y + swings.unseen(sum(u[1] for u in bent) << P - Q)

    def piece(self, low, high):
        middle, half = (low + high) / 2, (high - low) / 2
        mu, X, root_of_mu, known = self.approximate(middle, half)
        swings = self.swings(middle, half, mu, X)
        weight = swings.B.sigma
        weighed = lambda of_mu, of_motion, by=weight: up(of_mu * by.numerator, by.denominator) + of_motion
        beside = lambda u: sum(abs(m) for row in u[0] for m in row[1:]) << P - Q
        spread = weighed(beside(mu), sum(map(beside, X)))
        heavier = max(1, math.ceil(weight))
        R = up(65 * spread, 64) + (heavier * ONE >> 18)
        demand(swings.is_distinct(R), "the radius is too large")
        turned = part_of(swings.curvature(R), R)
        demand(turned < ONE, "Z2 R is not below 1")
        Z = swings.contraction() + turned
        demand(Z < ONE, "Z1 + Z2 R is not below 1")
        s = up(self.defect(swings, middle, half, mu, X) * ONE, ONE - Z)
        demand(spread + s <= R and s << 33 < ONE, f"B F is not small, but {s / ONE:.3g}")
        # This branch is that of the piece before, or of the file.
        ends = [[[sum(sign ** n * m for n, m in enumerate(row)) << P - Q for row in u[0]] for u in [mu] + X] for sign in (-1, 1)]
        balls = lambda end: ((end[0][0], 0), [[(m, 0) for m in c] for c in end[1:]])
        apart = lambda one, other: (size(add(one[0], other[0], -1)), sum(size(add(at(c, k), at(d, k), -1)) for c, d in zip(one[1], other[1])
                                                                          for k in range(max(len(c), len(d)))))
        mean = (swings.mu, [u[0] for u in swings.X])
        left_out = sum(u[2] for u in swings.X)
        if self.end is None:
            near = ONE >> 20
            if sum(apart(self.named, balls(ends[0]))) + s + swings.B.per_sigma(s) > near:
                raise Settled("the motion at the lower end of the range is not that of mu and c in mode")
            demand(weighed(*apart(self.named, mean)) + left_out + heavier * near <= R, "another motion may be as near to mu and c in mode")
        else:
            before, own, own_weight = self.end
            demand(weighed(*apart(before, mean)) + left_out + math.ceil(max(Fraction(1), weight / own_weight) * own) <= R, "the pieces do not join")
        # |1/omega - w| = |mu - w^2|/(1/omega + w).
        w = root_of_mu[0][0]
        lowest = w[0] - sum(map(abs, w[1:])) << P - Q
        demand(lowest > 0, "a frequency without a value")
        off = (sheet_norm(sheet_plus(sheet_times(root_of_mu, root_of_mu), mu, -1)) << P - Q) + swings.B.per_sigma(s)
        return (middle, half, by_powers(w), up(off * ONE, lowest)), (balls(ends[1]), s, weight), known[-3:], Z / ONE

    def pieces(self, low, high, spoken):
        steps = 1 << 14
        place, width = 0, steps // 8
        while place < steps:
            in_time()
            end = min(place + width, steps)
            try:
                piece, self.end, self.known, Z = self.piece(*(low + (high - low) * Fraction(n, steps) for n in (place, end)))
            except Settled:
                raise
            except (NotProved, OverflowError, ZeroDivisionError, ValueError) as error:
                width = (end - place) * 2 // 3
                if width == 0:
                    raise Settled(f"at {spoken(low + (high - low) * Fraction(place, steps))} no single motion of the mode is proved: {error}")
                continue
            yield piece
            place, width = end, max(1, int(width * min(1.4, 0.8 / Z)))


PLACES = 20                                 # on each piece


def by_powers(w):                           # of a cosine series in phi, of e = cos(phi)
    one, next_one, powers = [1], [0, 1], [0] * max(len(w), 2)
    for a in w:
        for n, m in enumerate(one):
            powers[n] += a * m
        one, next_one = next_one, [2 * m - n for m, n in itertools.zip_longest([0] + next_one, one, fillvalue=0)]
    return [(m << P - Q, 0) for m in powers]


def branch_of(z, name, low):
    """The mode of a law."""
    mode = z["mode"]
    keys(mode, {"coordinates", "f", "start_of", "first_harmonic_of", "mu", "c"}, set(), "mode")
    lists = mode["c"]
    demand(isinstance(lists, list) and 0 < len(lists) <= SIZES["coordinates"], "the number of coordinates")
    demand(all(isinstance(c, list) and 0 < len(c) <= 64 for c in lists), "at most 64 harmonics in c")
    lists = [[signed_claim(a, "c") for a in c] for c in lists]
    amplitude = {"value": "1", "start_of": mode["start_of"], "first_harmonic_of": mode["first_harmonic_of"]}
    names, forces, condition, _ = read_mode({**mode, "amplitude": amplitude}, len(lists))
    demand(name not in names, "a variable with the name of a coordinate")
    demand(all(at_zero(force) == 0 for force in forces), "a force that is not zero where all coordinates are")
    mu = signed_claim(mode["mu"], "mu")
    demand(mu > 0, "a frequency without a value")
    odd = all(a == 0 for c in lists for a in c[::2]) and all(parity(force, set(names)) in (-1, None) for force in forces)
    return ModeBranch(forces, names, name, condition, odd, low, mu, lists)


def signed_claim(text, what):               # a decimal or a fraction
    if isinstance(text, str) and "/" in text:
        return fraction(text, what)
    return -claim(text[1:], what) if isinstance(text, str) and text.startswith("-") else claim(text, what)


def check_law(z):
    global smallest
    is_contact, is_mode = z["ode"] == CONTACT, z["ode"] == LAW_OF_MODE
    smallest = ONE >> (30 if is_mode else 80)    # many short series; of modes what follows from them need not be sharp
    keys(z, {"schema", "ode", "f", "variable", "start", "quantity", "law", "from", "to", "worst", "error"}, {"mass", "mode"}, "the file")
    demand(z.get("mass") is None, "a mass that depends on the position is beyond this program")
    name = of_form("[A-Za-z_][A-Za-z0-9_]*", z["variable"], "a name in variable")
    demand(name not in FUNCTIONS + ("x", "pi") + (("e",) if is_contact else ()), "a variable with the name of something else")
    demand(isinstance(z["law"], str) and (z["f"] is None if is_mode else isinstance(z["f"], str)), "a text in f and in law")
    demand((z.get("mode") is not None) == is_mode, "a mode")
    law = steps_of(parse(z["law"], {name, "e"} if is_contact else {name}, True))
    start = None if z["start"] == "variable" else fraction(z["start"], "start")
    demand(start is None or start > 0, "a start that is not positive")
    powers = {"T/T_0": -1} if is_contact else {"omega": 1, "omega^2": 2, "T/(2*pi)": -1}
    demand(isinstance(z["quantity"], str) and z["quantity"] in powers, f"another quantity than {', '.join(powers)}")
    n, low, high = powers[z["quantity"]], fraction(z["from"], "from"), None if z["to"] is None else fraction(z["to"], "to")
    worst, claimed = fraction(z["worst"], "worst"), pair(z["error"], "error")
    demand(low >= 0 and (high is None or low < high), "an empty range, or one of negative numbers, in from and to")
    demand(high is not None or start is not None, "an amplitude or a speed that goes to infinity in to")
    demand(low <= worst and (high is None or worst <= high), "a worst place outside of the range")
    near_and_far = lambda is_far: lambda *ends: Interval(*ends, is_far)
    if is_contact:
        demand(start is None, "a start that is not the variable")
        power, c = contact_of(z["f"])
        demand(high * c <= HARDEST, f"a speed in to whose product with c in f is above {HARDEST}")
        demand(high * c >= Fraction(1, 10 ** 9), "a speed in to whose product with the c of f is below 1e-9")
        near = Contact(power, c, name)
        r_low, r_high = near.place(worst)
        r = hull(number(r_low), number(r_high))
        e = near.speed_and_restitution(scale(r, 2), *around_rest(scale(r, 2)))[1]
        there = Touch(r_low, r_high, {name: (number(worst), None), "e": (e, None)})
        ends = near.place(low)[0], near.place(high)[1]
        ranges = [(near, *ends, 0, lambda *ends: Touch(*ends, near.letters(*ends)), lambda r: near.speed(r))]
    elif is_mode:
        demand(start is None, "a start that is not the variable")
        demand(high is not None, "an amplitude that goes to infinity in to")
        near, there = branch_of(z, name, low), Interval(worst, worst, False)
        demand(low > 0 or near.is_polynomial, "a range from rest, of forces that are no polynomials: beyond this program")
        ranges = [(near, low, high, 0, near_and_far(False), lambda v: v)]
    else:
        force = parse(z["f"], {"x", name})
        demand(start is not None or not has_letter(force, name), "a force that contains the amplitude")
        family_of = Family if parity(force, {"x"}) in (-1, None) else Swing
        near, there = family_of(force, name, start), Interval(worst, worst, False)
        ranges = [(near, low, high, 0, near_and_far(False), lambda v: v)]
        if high is None:
            far, growth = in_reciprocal(force, name)
            ranges = [(near, low, Fraction(1), 0, near_and_far(False), lambda v: v)] if low < 1 else []
            far = family_of(far, name, start), Fraction(0), 1 / max(low, Fraction(1))
            ranges.append((*far, growth, near_and_far(True), lambda v: 1 / v if v else None))
    def hold_below(truth):
        below = least(add(over_truth(law, there, (truth, None), n, 0)[0], (ONE, 0), -1))
        demand(Fraction(below, ONE) >= claimed[0], f"at {name} = {worst} the error is not as large as claimed")
        return below

    # From below, at one place.
    if not is_mode:
        try:
            truth = near.inverse_frequency(r if is_contact else number(worst))
        except Settled:
            raise
        except NotProved as error:
            raise NotProved(f"at {name} = {decimal_of(worst)} in worst the truth of f is not enclosed: {error}")
        below = hold_below(truth)
    # From above, everywhere.
    above, most = 0, min(units(claimed[1]), 1000 * ONE)
    for family, begin, end, growth, interval, variable_of in ranges:
        spoken = lambda v: f"{name} = {'infinity' if variable_of(v) is None else decimal_of(variable_of(v))}"
        for piece in family.pieces(begin, end, spoken):
            middle, half, coefficients, remainder = piece
            if is_mode and abs(worst - middle) <= half:
                below = hold_below(enlarged(on_polynomial(coefficients, None, number((worst - middle) / half), False)[0], remainder))
            above = max(above, largest_on(piece, law, n, growth, interval, most, spoken))
    return {"law": f"{z['quantity']} = {z['law']}", "range": [z["from"], z["to"]], "largest_error": [decimal(below), decimal(above, 1)]}


# Impact orbits: x'' + c x' + k x = p + a cos(phi) + b sin(phi) between walls, with the phase for time and speeds by phase.

def rows_times(A, T):                       # of two rows each
    return [[total(mul(A[i][l], T[l][j]) for l in range(2)) for j in range(3)] for i in range(2)]


def after(second, first):                   # x -> A x + r, twice
    moved = rows_times(second, first)
    return [[moved[i][0], moved[i][1], add(moved[i][2], second[i][2])] for i in range(2)]


def motion_over(c, k, t):
    """Rows of exp(t M), M = ((0, 1, 0), (-k, -c, 1), (0, 0, 0)): the motion over t, and in the last column from rest under the force one."""
    if t[1] and t[0]:
        return after(motion_over(c, k, (0, t[1])), motion_over(c, k, (t[0], 0)))
    in_time()
    largest_row, halvings = max(ONE, size(c) + size(k) + ONE), 0
    while part_of(size(t), largest_row) << 1 > ONE << halvings:
        halvings += 1
    demand(halvings < 60, "numbers of an orbit that are too large")
    y = over(t, 1 << halvings)
    B = [[ZERO, y, ZERO], [minus_ball(mul(k, y)), minus_ball(mul(c, y)), y]]
    T, E = B, [[(ONE, 0), ZERO, ZERO], [ZERO, (ONE, 0), ZERO]]
    for n in range(2, 52):
        E = [[add(E[i][j], T[i][j]) for j in range(3)] for i in range(2)]
        T = [[over(a, n) for a in row] for row in rows_times(B, T)]
    E = [[enlarged(a, (ONE >> 250) + 1) for a in row] for row in E]    # 2 (1/2)^51/51! is below 2^-250
    for _ in range(halvings):
        E = after(E, E)
    return E


def minus_ball(a):
    return -a[0], a[1]


def wave_at(wave, angle):                   # value and two derivatives
    (sine, cosine), (constant_part, a, b) = angle, wave
    moving, slope = add(mul(a, cosine), mul(b, sine)), add(mul(b, cosine), mul(a, sine), -1)
    return add(constant_part, moving), slope, minus_ball(moving)


class Walled:
    def __init__(self, z):
        keys(z, {"schema", "ode", "c", "k", "driving_frequency", "load", "walls", "bits", "orbits"}, set(), "the file")
        omega = fraction(z["driving_frequency"], "driving_frequency")
        demand(omega > 0, "a frequency that is not positive")
        c, k = fraction(z["c"], "c") / omega, fraction(z["k"], "k") / omega ** 2
        p, a, b = (part / omega ** 2 for part in self.parts(z["load"], "load"))
        determinant = (k - 1) ** 2 + c ** 2
        demand(determinant > 0, "a drive at the natural frequency without damping")
        # (k - 1) U + c V = a, (k - 1) V - c U = b.
        self.wave = ZERO, number(((k - 1) * a - c * b) / determinant), number(((k - 1) * b + c * a) / determinant)
        self.omega, self.c, self.k, self.p = number(omega), number(c), number(k), number(p)
        self.load = number(p), number(a), number(b)
        demand(isinstance(z["walls"], list) and len(z["walls"]) in (1, 2), "one wall or two in walls")
        self.walls = []
        for wall in z["walls"]:
            keys(wall, {"side", "place", "restitution"}, set(), "walls")
            demand(wall["side"] in ("above", "below"), "above or below in side")
            e = fraction(wall["restitution"], "restitution")
            demand(0 <= e <= 1, "a restitution that is not from 0 to 1")
            self.walls.append((1 if wall["side"] == "below" else -1, tuple(map(number, self.parts(wall["place"], "place"))), number(e)))
        demand(len({side for side, *_ in self.walls}) == len(self.walls), "two walls on one side")

    @staticmethod
    def parts(value, what):
        keys(value, {"constant", "cosine", "sine"}, set(), what)
        return [fraction(value[key], what) for key in ("constant", "cosine", "sine")]

    def start(self, wall, angle, u):            # just after an impact, by the phase, by the speed
        side, place, e = self.walls[wall]
        x, slope, bent = wave_at(place, angle)
        return (x, add(slope, mul(e, u), side)), (slope, bent), (ZERO, scale(e, side))

    def free(self, E, angle, state):            # the motion without the steady wave
        x, slope, _ = wave_at(self.wave, angle)
        z = add(state[0], x, -1), add(state[1], slope, -1)
        return [total((mul(E[i][0], z[0]), mul(E[i][1], z[1]), mul(E[i][2], self.p))) for i in range(2)]

    def pulled(self, x, slope, force):
        return total((force, minus_ball(mul(self.c, slope)), minus_ball(mul(self.k, x))))

    def flights(self, walls, phases, turn):
        n = len(walls)
        for i in range(n):
            j = (i + 1) % n
            t = add(phases[j], phases[i], -1) if n > 1 else ZERO
            yield i, j, add(t, turn) if j == 0 else t

    def equations(self, walls, phases, speeds, turn):
        n = len(walls)
        angles = [waves_of_number(phase) for phase in phases]
        F, D = [], [[ZERO] * (2 * n) for _ in range(2 * n)]
        for i, j, t in self.flights(walls, phases, turn):
            E = motion_over(self.c, self.k, t)
            state, by_phase, by_speed = self.start(walls[i], angles[i], speeds[i])
            side, place, _ = self.walls[walls[j]]
            z = self.free(E, angles[i], state)
            left, right, target = wave_at(self.wave, angles[i]), wave_at(self.wave, angles[j]), wave_at(place, angles[j])
            later = z[1], self.pulled(z[0], z[1], self.p)
            F.append(total((right[0], z[0], minus_ball(target[0]))))
            F.append(total((right[1], z[1], minus_ball(target[1]), scale(speeds[j], side))))
            start = [add(by_phase[l], left[l + 1], -1) for l in range(2)]
            through = lambda state, row: add(mul(E[row][0], state[0]), mul(E[row][1], state[1]))
            for row in range(2):
                own = D[2 * i + row]
                own[2 * i] = add(own[2 * i], add(through(start, row), later[row], -1))
                own[2 * j] = total((own[2 * j], right[row + 1], later[row], minus_ball(target[row + 1])))
                own[2 * i + 1] = add(own[2 * i + 1], through(by_speed, row))
            D[2 * i + 1][2 * j + 1] = add(D[2 * i + 1][2 * j + 1], (side * ONE, 0))
        return F, D

    def newton(self, walls, middles, turn, radii, B):
        """Krawczyk: |B F| + |1 - B D| r < r, D over the whole box; the left side."""
        n = len(walls)
        box = [(m[0], r) for m, r in zip(middles, radii)]
        F, _ = self.equations(walls, middles[::2], middles[1::2], turn)
        _, D = self.equations(walls, box[::2], box[1::2], turn)
        proved = []
        for i, row in enumerate(B):
            step = size(total(map(mul, row, F)))
            images = (total(mul(row[l], D[l][j]) for l in range(2 * n)) for j in range(2 * n))
            away = sum(part_of(size(add(image, (ONE if i == j else 0, 0), -1)), radii[j]) + 1 for j, image in enumerate(images))
            demand(step + away < radii[i], "an orbit within these radii is not proved")
            proved.append(step + away)
        return proved

    def stays_off(self, walls, phases, speeds, i, j, t):
        angle = waves_of_number(phases[i])
        state = self.start(walls[i], angle, speeds[i])[0]
        parts = [(4, index) for index in range(16)]
        for looked_at in itertools.count():
            if not parts:
                return
            halvings, index = parts.pop()
            middle, half = mul(t, (2 * index + 1 << P - halvings - 1, 0)), size(t) >> halvings + 1
            begins, ends, split = index == 0, index + 1 == 1 << halvings, halvings < 24 and looked_at < 20000

            def at_time(time):
                E, turned_to = motion_over(self.c, self.k, time), waves_of_number(add(phases[i], time))
                z, w = self.free(E, angle, state), wave_at(self.wave, turned_to)
                return turned_to, add(w[0], z[0]), add(w[1], z[1])
            inside, (there, x, slope) = at_time(middle), at_time((middle[0], middle[1] + half + 1))
            bent = self.pulled(x, slope, wave_at(self.load, there)[0])
            for wall, (side, place, e) in enumerate(self.walls):
                here, all_of_it = wave_at(place, inside[0]), wave_at(place, there)
                rate_of, bend = scale(add(slope, all_of_it[1], -1), side), scale(add(bent, all_of_it[2], -1), side)
                gap = enlarged(scale(add(inside[1], here[0], -1), side), part_of(half + 1, size(rate_of)) + 1)
                rate_of = enlarged(scale(add(inside[2], here[1], -1), side), part_of(half + 1, size(bend)) + 1)
                grows = positive(rate_of) if e[0] else positive(bend)
                if not (positive(gap) or begins and wall == walls[i] and grows or ends and wall == walls[j] and positive(minus_ball(rate_of))):
                    demand(split, f"between impacts the orbit is not proved to stay off wall {wall + 1}")
                    parts += [(halvings + 1, 2 * index + 1), (halvings + 1, 2 * index)]
                    break


def positive(a):
    return a[0] > a[1]


def check_orbits(z):
    walled, bits = Walled(z), whole(z["bits"], 0, 224, "bits")
    demand(isinstance(z["orbits"], list) and 1 <= len(z["orbits"]) <= 200, "a list of at most 200 orbits")
    ends = lambda ball: [decimal(max(0, ball[0] - ball[1])), decimal(max(0, ball[0] + ball[1]), 1)]
    return {"orbits": [{key: list(map(ends, balls)) for key, balls in check_orbit(walled, orbit, bits).items()} for orbit in z["orbits"]]}


def check_orbit(walled, z, bits):
    keys(z, {"periods", "impacts", "phase_radius", "speed_radius", "isolated_in_phase", "isolated_in_speed", "stability"}, set(), "orbits")
    turn = scale(PI, 2 * whole(z["periods"], 1, 100, "periods"))
    demand(isinstance(z["impacts"], list) and 1 <= len(z["impacts"]) <= 40, "a list of at most 40 impacts")
    walls, middles, roundings = [], [], []
    for impact in z["impacts"]:
        keys(impact, {"wall", "phase", "speed"}, set(), "impacts")
        walls.append(whole(impact["wall"], 1, len(walled.walls), "wall") - 1)
        phase, speed = (dyadic(integer(impact[key], key), bits) for key in ("phase", "speed"))
        u = quotient(speed, walled.omega)
        middles += [phase, (u[0], 0)]
        roundings += [0, u[1]]                  # a part of the radius
    claims = [[claim(z[f"{name}_{what}"] if what == "radius" else z[f"isolated_in_{name}"], what) for name in ("phase", "speed")]
              for what in ("radius", "isolated")]
    radii = [[up(r.numerator * ONE, r.denominator) for r in pair] for pair in claims]
    demand(all(r < ONE << 300 for pair in radii for r in pair), "a radius that is too large")
    radii = [[one + other for one, other in zip([r[0], size(quotient((r[1], 0), walled.omega))] * len(walls), roundings)] for r in radii]
    D = walled.equations(walls, middles[::2], middles[1::2], turn)[1]
    demand(all(size(a) < ONE << 300 for row in D for a in row), "numbers of an orbit that are too large")
    B = inverse_nearly([[a[0] / ONE for a in row] for row in D])
    demand(all(map(math.isfinite, itertools.chain(*B))), "a derivative without an inverse")
    B = [[number(Fraction(entry)) for entry in row] for row in B]
    walled.newton(walls, middles, turn, radii[1], B)
    proved = walled.newton(walls, middles, turn, radii[0], B)
    balls = [(m[0], r) for m, r in zip(middles, proved)]
    phases, speeds = balls[::2], balls[1::2]
    demand(all(map(positive, speeds)), "an impact grazes the wall: its speed is not proved to be positive")
    flights = list(walled.flights(walls, phases, turn))
    demand(all(positive(t) for *_, t in flights), "the impacts are not in order of time")
    for i, j, t in flights:
        walled.stays_off(walls, phases, speeds, i, j, t)
    return {"phases": phases, "speeds": [mul(u, walled.omega) for u in speeds]}


def decimal_of(x):                          # for a sentence
    return f"{float(x):.6g}" if abs(x) < 10 ** 300 else "a large number"


def check(text):
    demand(len(text) <= SIZES["file"], "a file of at most 16 MB")
    z = json.loads(text, object_pairs_hook=unique, parse_float=no_number, parse_constant=no_number,
                   parse_int=lambda digits: int(digits) if len(digits) <= 20 else no_number(digits))
    demand(isinstance(z, dict) and z.get("schema") == "lindstedt/certificate/1", "another schema")
    if z.get("ode") in (LAW, CONTACT, LAW_OF_MODE):
        return check_law(z)
    if z.get("ode") == WALLS:
        return check_orbits(z)
    demand(z.get("nu") == "1", "another schema")
    z = with_names_in_words(z)
    kind = z.get("ode")
    demand(kind in (MOTION, MODE, CYCLE, DRIVEN, CYCLES, ALL_DRIVEN), "another equation")
    own = {MOTION: {"f", "initial_displacement", "mu"}, MODE: {"f", "coordinates", "amplitude", "mu"}, CYCLE: {"g", "h", "p", "s"}, DRIVEN: {"g", "h", "drive", "s"},
           CYCLES: {"g", "h", "coordinates", "phase_of", "p", "s"}, ALL_DRIVEN: {"g", "h", "coordinates", "drive", "s"}}[kind]
    own |= set() if kind == ALL_DRIVEN else {"sigma_log2"}
    others = {"stability"} if kind not in (MOTION, MODE) else set()
    others |= set() if kind in (CYCLES, ALL_DRIVEN) else {"formula"}
    keys(z, {"schema", "ode", "odd", "bits", "c", "highest_harmonic", "inverse_bits", "inverse", "nu", "claim_r"} | own, others, "the file")
    N, odd = whole(z["highest_harmonic"], 1, 400, "highest_harmonic"), z["odd"]
    bits, inverse_bits = whole(z["bits"], 0, 224, "bits"), whole(z["inverse_bits"], 0, 224, "inverse_bits")
    exponent = whole(z.get("sigma_log2", 0), -64, 64, "sigma_log2")
    demand(type(odd) is bool and (not odd or N % 2 == 1), "odd harmonics, and a block that ends with an even one")
    rows = z["inverse"]
    demand(isinstance(rows, list) and len(rows) <= SIZES["block"], "the size of the inverse")
    rows = [integers(row, "inverse") for row in rows]
    step, sigma = 2 if odd else 1, Fraction(2) ** exponent
    several = kind in (MODE, CYCLES, ALL_DRIVEN)
    lists = z["c"] if several else [z["c"]]
    demand(isinstance(lists, list) and len(lists) <= SIZES["coordinates"], "the number of coordinates")
    lists = [[dyadic(a, bits) for a in integers(c, "c")] for c in lists]
    demand(not odd or all(a == ZERO for c in lists for a in c[::2]), "even harmonics")
    c = lists[0] if lists else []
    harmonics = list(range(1 if odd else 0, N + 1, step))
    omega = amplitude = start = None
    if kind in (MOTION, MODE):
        if kind == MOTION:
            names, forces, condition = ["x"], [read_force(z["f"], {"x"}, "f")], 0
            start = A = fraction(z["initial_displacement"], "initial_displacement")
        else:
            names, forces, condition, A = read_mode(z, len(lists))
            start = condition, A
        unknowns = len(harmonics) * len(names) + 1
        demand(unknowns <= 402 and len(rows) == unknowns and all(len(row) == len(rows) for row in rows), "the size of the inverse")
        demand(not odd or all(parity(f, set(names)) in (-1, None) for f in forces), "the force is not odd")
        mu, B, X = dyadic(integer(z["mu"], "mu"), bits), Block(rows, inverse_bits, sigma), [(c, [], 0) for c in lists]
        r = prove_motion(forces, names, condition, A, B, harmonics, odd, mu, X)
        omega, copies = root(quotient((ONE, 0), (mu[0], B.per_sigma(r)))), X
    else:
        free = kind in (CYCLE, CYCLES)
        names, g, h = read_damped(z, len(lists), several, free)
        count, phase = range(len(names)), 0 if free else None
        if kind == CYCLES:
            demand(z["phase_of"] in names, "the name of a coordinate in phase_of")
            phase = names.index(z["phase_of"])
        sines = z["s"] if several else [z["s"]]
        demand(isinstance(sines, list) and len(sines) == len(names), "the number of coordinates")
        sines = [[dyadic(b, bits) for b in integers(s, "s")] for s in sines]
        demand(all(b == ZERO for i, s in enumerate(sines) for b in s[:2 if i == phase else 1]), "a sine of the first harmonic, or one of the constant")
        demand(not odd or all(b == ZERO for s in sines for b in s[::2]), "even harmonics")
        block = [(i, kind, k) for i in count for k in harmonics for kind in (0, 1) if (kind, k) != (1, 0)]
        if free:
            block = [(phase, 1, 1)] + [wave for wave in block if wave != (phase, 1, 1)]
        demand(len(block) <= 401, "a block of more than 401 unknowns")
        demand(len(rows) == len(block) and all(len(row) == len(rows) for row in rows), "the size of the inverse")
        X = [(c, s, 0) for c, s in zip(lists, sines)]
        waves, periods, harmonic = dict(zip(names, X)), 1, 1
        if free:
            demand(at(X[phase][0], 1)[0] > 0, "a first harmonic that is no positive cosine")
            p, B = dyadic(integer(z["p"], "p"), bits), Block(rows, inverse_bits, sigma)
            demand(p[0] > 0, "1/omega is not positive")
        else:
            z["drive"] = with_names_in_words(z["drive"])
            keys(z["drive"], {"driving_frequency", "n", "harmonic"}, set(), "drive")
            frequency = fraction(z["drive"]["driving_frequency"], "driving_frequency")
            periods = whole(z["drive"]["n"], 1, 20, "n")
            harmonic = whole(z["drive"]["harmonic"], 1, 400, "harmonic")
            demand(frequency > 0 and exponent == 0, "a drive whose frequency is positive, and no weight")
            p, B = number(periods / frequency), Block(rows, inverse_bits, None)
            waves.update(c=([ZERO] * periods + [(ONE, 0)], [], 0), s=([], [ZERO] * periods + [(ONE, 0)], 0))
        half = set(names) | ({"c", "s"} if not free and periods % 2 == 1 else set())
        demand(not odd or is_mirror_image(g, h, half), "the equation is not odd")
        r = prove_damped(g, h, names, waves, B, block, N, step, p, phase)
        if free:
            omega = quotient((ONE, 0), (p[0], B.per_sigma(r)))
        if not free or several:
            amplitudes = [(a[0], a[1] + r) for a in (formula_amplitude(u, harmonic) for u in X)]
            amplitude = amplitudes[0]
        copies = X
        if z.get("formula") is not None:
            copies = symmetric_copies(X[0], g, h, free, periods, odd)
    # Rounding is another here than where the radius was claimed.
    demand(Fraction(r, ONE) <= claim(z["claim_r"], "claim_r") * (1 + Fraction(1, 1000)) + Fraction(1, 2**120), "a smaller radius is claimed")
    if z.get("formula") is not None:
        check_formula(z, kind, bits, copies, r, omega, amplitude, start)
    proved = {"r": f"{up(r * 10 ** 40, ONE)}e-40"}
    ends = lambda ball: [decimal(max(0, ball[0] - ball[1])), decimal(ball[0] + ball[1], 1)]
    if omega:
        proved["omega"] = ends(omega)
    elif not several:
        proved["amplitude"] = ends(amplitude)
    if kind in (CYCLES, ALL_DRIVEN):
        proved["amplitudes"] = list(map(ends, amplitudes))
    return proved


def read_damped(z, count, several, free):
    """The names of the coordinates, the matrix g and the forces h."""
    waves = set() if free else {"c", "s"}
    if not several:
        return ["x"], [[read_force(z["g"], {"x"}, "g")]], [read_force(z["h"], {"x"} | waves, "h")]
    names, g, h = z["coordinates"], z["g"], z["h"]
    read_names(names, count)
    demand(not waves & set(names), "a coordinate with the name of a wave of the drive")
    demand(all(isinstance(rows, list) and len(rows) == count for rows in (g, h)), "the number of coordinates")
    demand(all(isinstance(row, list) and len(row) == count for row in g), "the number of coordinates")
    demand(all(isinstance(text, str) for row in g + [h] for text in row), "a force in g or h")
    g = [[parse(text, set(names)) for text in row] for row in g]
    demand(all(is_potential(row, names) for row in g), "a row of g that is seen to be no derivative of one function")
    return names, g, [parse(text, set(names) | waves) for text in h]


def read_names(names, count):
    demand(isinstance(names, list) and 0 < len(names) == count, "the number of coordinates")
    for name in names:
        known = isinstance(name, str) and len(name) <= SIZES["number"] and re.fullmatch("[A-Za-z]+", name, re.ASCII)
        demand(known and name not in ("sin", "cos", "t", "pi"), "a coordinate that this program does not know")
    demand(len(set(names)) == len(names), "two coordinates of one name")


def read_mode(z, count):
    """The names of the coordinates, their forces, the condition and the amplitude."""
    names, texts, amplitude = z["coordinates"], z["f"], z["amplitude"]
    read_names(names, count)
    demand(isinstance(texts, list) and len(texts) == count, "the number of coordinates")
    demand(all(isinstance(text, str) for text in texts), "a force in f")
    keys(amplitude, {"value", "start_of", "first_harmonic_of"}, set(), "amplitude")
    place, factors = amplitude["start_of"], amplitude["first_harmonic_of"]
    demand((place is None) != (factors is None), "one condition in amplitude")
    if factors is None:
        demand(place in names, "the name of a coordinate in start_of")
        condition = names.index(place)
    else:
        demand(isinstance(factors, list) and len(factors) == count and all(isinstance(text, str) for text in factors), "a factor of each coordinate")
        series = [jets(parse(text, set()), {}, ())[0] for text in factors]
        condition = [(at(u[0], 0)[0], at(u[0], 0)[1] + u[2]) for u in series]
    return names, [parse(text, set(names)) for text in texts], condition, fraction(amplitude["value"], "amplitude")


def symmetric_copies(X, g, h, free, periods, odd):
    """X any number of periods of the drive later, and -X where the equation is its own mirror image: at once, or half a period of the
    drive later (of a cycle half its own)."""
    def later(j):                           # by the angle pi j/n
        s, c = angle(over(scale(PI, j), periods))
        return turned(X, c, s) if j else X

    copies = [later(2 * m) for m in range(periods)]
    if free:
        at_once, half_later = False, not odd and is_mirror_image(g, h, {"x"})
    else:
        at_once, half_later = (is_mirror_image(g, h, letters) for letters in ({"x"}, {"x", "c", "s"}))
        if odd:                             # its own symmetry makes nothing new
            at_once, half_later = at_once and periods % 2 == 1, half_later and periods % 2 == 0
    if at_once:
        copies += [minus(later(2 * m)) for m in range(periods)]
    if half_later:
        copies += [minus(later(2 * m + 1)) for m in range(periods)]
    return copies


def decimal(x, up_to=0):                    # thirty-six decimals, rounded down or up
    digits = str(up(x * 10 ** 36, ONE) if up_to else x * 10 ** 36 // ONE).rjust(37, "0")
    return digits[:-36] + "." + digits[-36:]


if __name__ == "__main__":
    try:
        with open(sys.argv[1], encoding="utf-8") as file:
            proved = check(file.read(SIZES["file"] + 1))
    except (NotProved, json.JSONDecodeError, UnicodeDecodeError, RecursionError) as error:
        words = str(error) if isinstance(error, NotProved) else "no JSON"
        sys.exit(f"not proved: {words}")
    print(json.dumps(proved))
