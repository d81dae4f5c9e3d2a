//! Kinds `simulation` and `sweep`.

use std::io;

use serde_json::{Value, json};

use super::{COMPARED, Report, SweepReport, friction, notes};
use crate::damper::sweep::Summary;
use crate::damper::{Integrator, Simulation};

/// One run.
pub fn simulation(report: &Report) -> Value {
    let motion = report.motion;
    let model = &motion.model;
    let [gamma_source, mu_source] = report.sources;
    let book = motion.energy();
    let rest = motion.rest();
    let impacts: Vec<Value> = motion
        .impacts
        .iter()
        .map(|impact| {
            json!({
                "entry_time": impact.entry_time,
                "exit_time": impact.exit_time,
                "speed_in": impact.speed_in,
                "speed_out": impact.speed_out,
                "penetration": impact.penetration,
                "restitution": impact.restitution,
                "energy_lost": impact.energy_lost,
                "side": impact.side.name(),
            })
        })
        .collect();
    let samples: Vec<Value> = report
        .samples
        .iter()
        .map(|&t| match motion.path.at(t) {
            Some((x, velocity)) => json!({ "t": t, "x": x, "velocity": velocity }),
            None => json!({ "t": t, "x": null, "velocity": null }),
        })
        .collect();
    let judge = report.judge.map(|judge| {
        let difference = motion.difference(judge, COMPARED);
        json!({
            "integrator": integrator(judge),
            "impacts": judge.impacts.len(),
            "max_difference": { "x": difference.displacement, "velocity": difference.velocity, "until": difference.until },
            "final_state": final_state(judge),
            "energy_residual": judge.energy().residual,
            "stopped": judge.stop.to_string(),
        })
    });
    json!({
        "schema": "lindstedt/simulation/1",
        "parameters": {
            "barrier": { "left": model.left, "right": model.right },
            "start": motion.start.x,
            "speed": motion.start.velocity,
            "gamma": model.gamma,
            "gamma_source": gamma_source,
            "mu": model.mu,
            "mu_source": mu_source,
            "zeta": model.zeta,
            "alpha": model.alpha,
            "friction": friction(model.friction),
            "beta": model.beta,
            "frequency_ratio": model.frequency_ratio,
            "duration": motion.options.duration,
            "integrator_tolerance": report.tolerance,
            "step_tolerance": motion.options.relative_tolerance,
        },
        "integrator": integrator(motion),
        "final_state": final_state(motion),
        "samples": samples,
        "impacts": impacts,
        "rest_time": rest.time.ok(),
        "rest_reason": rest.time.err().map(|reason| reason.to_string()),
        "last_crossing": rest.last_crossing,
        "energy": {
            "start": book.start,
            "end": book.end,
            "viscous": book.viscous,
            "friction": book.friction,
            "contact": book.contact,
            "excitation": book.excitation,
        },
        "energy_residual": book.residual,
        "stopped": motion.stop.to_string(),
        "complete": motion.stop.is_complete(),
        "steps": motion.steps,
        "judge": judge,
        "notes": notes(report),
    })
}

fn integrator(motion: &Simulation) -> &'static str {
    match motion.integrator {
        Integrator::Taylor => "taylor",
        Integrator::RungeKutta => "runge-kutta",
    }
}

fn final_state(motion: &Simulation) -> Value {
    json!({ "t": motion.end_time, "x": motion.end_x, "velocity": motion.end_velocity })
}

/// A sweep, a row at a time, for there may be a million.
///
/// # Errors
/// What the writer says.
pub fn sweep(report: &SweepReport, to: &mut dyn io::Write) -> io::Result<()> {
    let axes: Vec<Value> = report
        .axes
        .iter()
        .map(|axis| json!({ "name": axis.name, "from": axis.from, "to": axis.to, "count": axis.count }))
        .collect();
    // The document without its rows, cut open before its last brace.
    let head = format!("{:#}", json!({ "schema": "lindstedt/sweep/1", "axes": axes }));
    let open = head.trim_end_matches(['\n', '}']);
    write!(to, "{open},\n  \"rows\": [")?;
    for (row, summary) in report.rows.iter().enumerate() {
        let separator = if row == 0 { "" } else { "," };
        let text = format!("{:#}", document(&report.values(row), summary));
        write!(to, "{separator}\n    {}", text.replace('\n', "\n    "))?;
    }
    writeln!(to, "\n  ]\n}}")
}

/// A row of a sweep.
fn document(values: &[f64], summary: &Summary) -> Value {
    json!({
        "values": values,
        "impacts": summary.impacts,
        "rest_time": summary.rest_time.ok(),
        "penetration": summary.deepest,
        "speed_in": summary.fastest,
        "energy_lost": summary.energy_lost,
        "final_state": { "t": summary.end_time, "x": summary.end_x, "velocity": summary.end_velocity },
        "complete": summary.stop.is_complete(),
        "stopped": summary.stop.to_string(),
    })
}
