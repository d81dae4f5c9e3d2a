//! Julia, with the functions of `Base`. A number that does not exist is a `DomainError`.

use super::{Base, Break, Exponent, Syntax, Text, UsedRoutines};
use crate::expr::Function;

pub(super) const SYNTAX: Syntax = Syntax {
    name: "julia",
    comment: "#",
    reserved: &[
        "abstract",
        "baremodule",
        "begin",
        "break",
        "catch",
        "const",
        "continue",
        "do",
        "else",
        "elseif",
        "end",
        "export",
        "false",
        "finally",
        "for",
        "function",
        "global",
        "if",
        "import",
        "in",
        "isa",
        "let",
        "local",
        "macro",
        "module",
        "mutable",
        "new",
        "outer",
        "primitive",
        "public",
        "quote",
        "return",
        "struct",
        "throw",
        "true",
        "try",
        "type",
        "using",
        "where",
        "while",
        "abs",
        "copysign",
        "float",
        "pi",
        "sqrt",
        "DomainError",
    ],
    point: "",
    pi: "pi",
    operators: ["*", "/"],
    between_values: ["*", "/"],
    power: |Base { inside, operand, .. }, exponent| match exponent {
        Exponent::Whole(number) => format!("{operand}^{number}"),
        Exponent::Half => format!("sqrt({inside})"),
        Exponent::OddRoot(number, true) => format!("copysign(abs({inside})^({number}), {inside})"),
        Exponent::OddRoot(number, false) => format!("abs({inside})^({number})"),
        Exponent::Real(number) => format!("{operand}^({number})"),
    },
    function,
    helper,
    variable: |name, _| [format!("{name} = "), String::new()],
    result: ["return ", ""],
    size: |name| format!("{name} = abs({name})"),
    unused: None,
    positive: |name, _, reason| format!("{name} > 0 || throw(DomainError({name}, \"{reason}\"))"),
    breaks: Break::AfterSigns(""),
    beginning: |_: &UsedRoutines| String::new(),
    routine,
};

fn function(function: Function) -> &'static str {
    match function {
        Function::Absolute => "abs",
        Function::Sign => "sign",
        Function::Step => "heaviside",
        Function::BesselJ0 => "bessel_j0",
        Function::BesselJ1 => "bessel_j1",
        Function::BesselI0 => "bessel_i0",
        Function::BesselI1 => "bessel_i1",
        Function::Gamma => "gamma_function",
        Function::EllipticK => "elliptic_k",
        Function::JacobiSn => "jacobi_sn",
        Function::JacobiCn => "jacobi_cn",
        Function::JacobiDn => "jacobi_dn",
        other => other.name(),
    }
}

/// Whole numbers as arguments are converted to floating-point ones, because their powers would
/// overflow.
fn routine(text: &Text) -> String {
    let head =
        format!("\"{}.\"\nfunction {}({})\n", text.about, text.name, text.arguments.join(", "));
    let converted = match text.arguments {
        [] => None,
        [only] => Some(format!("    {only} = float({only})\n")),
        several => {
            let list = several.join(", ");
            Some(format!("    {list} = float.(({list}))\n"))
        }
    };
    let lines = text.lines.iter().map(|line| format!("    {line}\n"));
    let beginning = [head].into_iter().chain(converted);
    beginning.chain(lines).chain(["end\n".to_owned()]).collect()
}

fn helper(function: Function) -> Option<&'static str> {
    Some(match function {
        Function::Step => {
            r#""1 where u is positive, 0 elsewhere."
heaviside(u) = u > 0 ? 1.0 : 0.0
"#
        }
        Function::BesselJ0 => {
            r#""The Bessel function of the first kind, a mean over half a turn."
function bessel_j0(u)
    count = 32 + ceil(Int, abs(u))
    return sum(cos(u*sin(pi*(k - 0.5)/count)) for k in 1:count)/count
end
"#
        }
        Function::BesselJ1 => {
            r#""The Bessel function of the first kind and of order one, a mean over half a turn."
function bessel_j1(u)
    count = 32 + ceil(Int, abs(u))
    sines = (sin(pi*(k - 0.5)/count) for k in 1:count)
    return sum(sine*sin(u*sine) for sine in sines)/count
end
"#
        }
        Function::BesselI0 => {
            r#""The modified Bessel function of the first kind, a mean over half a turn."
function bessel_i0(u)
    count = 32 + ceil(Int, abs(u))
    return sum(cosh(u*cos(pi*(k - 0.5)/count)) for k in 1:count)/count
end
"#
        }
        Function::BesselI1 => {
            r#""The modified Bessel function of the first kind and of order one, a mean over half a turn."
function bessel_i1(u)
    count = 32 + ceil(Int, abs(u))
    cosines = (cos(pi*(k - 0.5)/count) for k in 1:count)
    return sum(cosine*sinh(u*cosine) for cosine in cosines)/count
end
"#
        }
        Function::Gamma => {
            r#""The Gamma function, by Lanczos' approximation."
function gamma_function(u)
    u < 0.5 && return pi/(sin(pi*u)*gamma_function(1 - u))
    terms = (676.5203681218851, -1259.1392167224028, 771.32342877765313, -176.61502916214059,
             12.507343278686905, -0.13857109526572012, 9.9843695780195716e-6, 1.5056327351493116e-7)
    total = 0.99999999999980993 + sum(term/(u - 1 + k) for (k, term) in enumerate(terms))
    t = u + 6.5
    return sqrt(2*pi)*t^(u - 0.5)*exp(-t)*total
end
"#
        }
        Function::EllipticK => {
            r#""The complete elliptic integral of the first kind, m = k^2 < 1, by the arithmetic-geometric mean."
function elliptic_k(m)
    m < 1 || throw(DomainError(m, "K(m) has no value for m >= 1"))
    a, b = 1.0, sqrt(1 - m)
    for _ in 1:40
        a, b = (a + b)/2, sqrt(a*b)
    end
    return pi/(a + b)
end
"#
        }
        Function::JacobiSn => {
            r#""The elliptic functions sn, cn and dn of Jacobi, m = k^2 < 1, by the arithmetic-geometric mean."
function jacobi_functions(u, m)
    m < 1 || throw(DomainError(m, "sn, cn and dn have no value for m >= 1 here"))
    if m < 0
        scale = sqrt(1 - m)
        s, c, d = jacobi_functions(u*scale, -m/(1 - m))
        return s/(d*scale), c/d, 1/d
    end
    a, b = 1.0, sqrt(1 - m)
    ratios = zeros(8)
    for k in 1:8
        ratios[k] = (a - b)/(a + b)
        a, b = (a + b)/2, sqrt(a*b)
    end
    phi = 256*a*u
    for k in 8:-1:1
        phi = (phi + asin(ratios[k]*sin(phi)))/2
    end
    s, c = sin(phi), cos(phi)
    return s, c, sqrt(c*c + (1 - m)*s*s)
end

"The elliptic function sn of Jacobi."
function jacobi_sn(u, m)
    return jacobi_functions(u, m)[1]
end
"#
        }
        Function::JacobiCn => {
            r#""The elliptic function cn of Jacobi."
function jacobi_cn(u, m)
    return jacobi_functions(u, m)[2]
end
"#
        }
        Function::JacobiDn => {
            r#""The elliptic function dn of Jacobi."
function jacobi_dn(u, m)
    return jacobi_functions(u, m)[3]
end
"#
        }
        _ => return None,
    })
}
