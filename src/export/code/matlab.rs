//! MATLAB and GNU Octave. Arguments may be arrays. A number that does not exist is NaN, or an error
//! of `realsqrt` and similar functions, which replace functions that would give complex numbers.

use super::{Base, Break, Exponent, Syntax, Text, UsedRoutines};
use crate::expr::Function;

pub(super) const SYNTAX: Syntax = Syntax {
    name: "matlab",
    comment: "%",
    reserved: &[
        "break",
        "case",
        "catch",
        "classdef",
        "continue",
        "do",
        "else",
        "elseif",
        "end",
        "end_try_catch",
        "endfor",
        "endfunction",
        "endif",
        "endswitch",
        "endwhile",
        "for",
        "function",
        "global",
        "if",
        "otherwise",
        "parfor",
        "persistent",
        "return",
        "spmd",
        "switch",
        "try",
        "until",
        "unwind_protect",
        "while",
        "NaN",
        "abs",
        "motion",
        "pi",
        "realpow",
        "realsqrt",
        "sign",
        "value",
    ],
    point: "",
    pi: "pi",
    operators: ["*", "/"],
    between_values: [".*", "./"],
    power: |Base { inside, operand, .. }, exponent| match exponent {
        Exponent::Whole(number) => format!("{operand}.^{number}"),
        Exponent::Half => format!("realsqrt({inside})"),
        Exponent::OddRoot(number, true) => format!("(sign({inside}).*abs({inside}).^({number}))"),
        Exponent::OddRoot(number, false) => format!("abs({inside}).^({number})"),
        Exponent::Real(number) => format!("realpow({inside}, {number})"),
    },
    function,
    helper,
    variable: |name, _| [format!("{name} = "), ";".to_owned()],
    result: ["value = ", ";"],
    size: |name| format!("{name} = abs({name});"),
    unused: None,
    positive: |name, spoilt, reason| format!("{spoilt}(~({name} > 0)) = NaN;  % {reason}"),
    breaks: Break::AfterSigns(" ..."),
    beginning,
    routine,
};

fn function(function: Function) -> &'static str {
    match function {
        Function::Absolute => "abs",
        Function::Sign => "sign",
        Function::Log => "reallog",
        Function::Asin => "real_asin",
        Function::Acos => "real_acos",
        Function::Step => "heaviside_step",
        Function::BesselJ0 => "bessel_j0",
        Function::BesselJ1 => "bessel_j1",
        Function::BesselI0 => "bessel_i0",
        Function::BesselI1 => "bessel_i1",
        Function::Gamma => "gamma",
        Function::EllipticK => "elliptic_k",
        Function::JacobiSn => "jacobi_sn",
        Function::JacobiCn => "jacobi_cn",
        Function::JacobiDn => "jacobi_dn",
        other => other.name(),
    }
}

/// Only one function of a file can be called from outside; it returns handles of the others.
fn beginning(used: &UsedRoutines) -> String {
    let handles = used.routines.iter().map(|name| format!("    motion.{name} = @{name};\n"));
    let head = "% Save this as oscillator.m: motion = oscillator(); then motion.displacement(t, ...), and so on.\n\
                function motion = oscillator()\n";
    let head = match (used.routines.contains(&"displacement"), used.routines) {
        (true, _) => head.to_owned(),
        (false, [only]) => head.replace("displacement(t, ...), and so on", &format!("{only}(...)")),
        (false, several) => {
            let first = several.iter().find(|name| name.contains("displacement"));
            head.replace("displacement", first.unwrap_or(&"angular_frequency"))
        }
    };
    std::iter::once(head).chain(handles).chain(["end\n".to_owned()]).collect()
}

fn routine(text: &Text) -> String {
    let head = format!(
        "% {}.\nfunction value = {}({})\n",
        text.about,
        text.name,
        text.arguments.join(", ")
    );
    let lines = text.lines.iter().map(|line| format!("    {line}\n"));
    std::iter::once(head).chain(lines).chain(["end\n".to_owned()]).collect()
}

fn helper(function: Function) -> Option<&'static str> {
    Some(match function {
        Function::Asin => {
            "% The arcsine of a real number, NaN beyond -1 and 1.
function value = real_asin(u)
    u(abs(u) > 1) = NaN;
    value = asin(u);
end
"
        }
        Function::Acos => {
            "% The arccosine of a real number, NaN beyond -1 and 1.
function value = real_acos(u)
    u(abs(u) > 1) = NaN;
    value = acos(u);
end
"
        }
        Function::Step => {
            "% 1 where u is positive, 0 elsewhere.
function value = heaviside_step(u)
    value = double(u > 0);
end
"
        }
        Function::BesselJ0 => {
            "% The Bessel function of the first kind; of negative numbers it comes as a complex one.
function value = bessel_j0(u)
    value = real(besselj(0, u));
end
"
        }
        Function::BesselJ1 => {
            "% The Bessel function of the first kind and of order one.
function value = bessel_j1(u)
    value = real(besselj(1, u));
end
"
        }
        Function::BesselI0 => {
            "% The modified Bessel function of the first kind.
function value = bessel_i0(u)
    value = real(besseli(0, u));
end
"
        }
        Function::BesselI1 => {
            "% The modified Bessel function of the first kind and of order one.
function value = bessel_i1(u)
    value = real(besseli(1, u));
end
"
        }
        Function::EllipticK => {
            "% The complete elliptic integral of the first kind, m = k^2 < 1, by the arithmetic-geometric mean.
function value = elliptic_k(m)
    m(~(m < 1)) = NaN;
    a = ones(size(m));
    b = sqrt(1 - m);
    for k = 1:40
        mean_of_both = (a + b)/2;
        b = sqrt(a.*b);
        a = mean_of_both;
    end
    value = pi./(a + b);
end
"
        }
        Function::JacobiSn => {
            "% The elliptic functions sn, cn and dn of Jacobi, m = k^2 < 1, by the arithmetic-geometric mean.
function [s, c, d] = jacobi_functions(u, m)
    u = u + 0*m;
    m = m + 0*u;
    m(~(m < 1)) = NaN;
    scale = sqrt(1 - min(m, 0));
    p = max(m, 0) - min(m, 0)./(1 - min(m, 0));
    a = ones(size(m));
    b = sqrt(1 - p);
    ratios = cell(1, 8);
    for k = 1:8
        ratios{k} = (a - b)./(a + b);
        mean_of_both = (a + b)/2;
        b = sqrt(a.*b);
        a = mean_of_both;
    end
    phi = 256*a.*u.*scale;
    for k = 8:-1:1
        phi = (phi + asin(ratios{k}.*sin(phi)))/2;
    end
    s = sin(phi);
    c = cos(phi);
    d = sqrt(c.^2 + (1 - p).*s.^2);
    below = ones(size(m));
    below(m < 0) = d(m < 0);
    s = s./(below.*scale);
    c = c./below;
    d(m < 0) = 1./d(m < 0);
end

% The elliptic function sn of Jacobi.
function value = jacobi_sn(u, m)
    [value, ~, ~] = jacobi_functions(u, m);
end
"
        }
        Function::JacobiCn => {
            "% The elliptic function cn of Jacobi.
function value = jacobi_cn(u, m)
    [~, value, ~] = jacobi_functions(u, m);
end
"
        }
        Function::JacobiDn => {
            "% The elliptic function dn of Jacobi.
function value = jacobi_dn(u, m)
    [~, ~, value] = jacobi_functions(u, m);
end
"
        }
        _ => return None,
    })
}
