//! Recording calls of shaders.

use super::declaration::{Declared, Work};
use crate::error::Error;
use crate::execute::{BodyResult, ComputeContext, RenderContext, Resources};
use crate::handle::BufferToken;

/// Records a call into an open render pass.
pub(crate) fn draw(context: &mut RenderContext<'_>, call: u32) -> BodyResult {
    let resources = &context.resources;
    let Some(call) = resources.calls().get(call) else { return Ok(()) };
    let Work::Draw(attachments) = &call.work else { return Ok(()) };
    let made = resources.caches().pipelines.render(resources.device(), &call.program, attachments);
    let made = made.map_err(|error| in_pass(resources, error))?;
    let group = group(resources, &made.layout, call)?;
    context.pass.set_pipeline(&made.pipeline);
    if let Some(group) = &group {
        context.pass.set_bind_group(0, group, &[]);
    }
    context.pass.draw(0..3, 0..1);
    context.report_draws(1);
    Ok(())
}

/// Records a call into an open compute pass.
pub(crate) fn dispatch(context: &mut ComputeContext<'_>, call: u32) -> BodyResult {
    let resources = &context.resources;
    let Some(call) = resources.calls().get(call) else { return Ok(()) };
    let made = resources.caches().pipelines.compute(resources.device(), &call.program);
    let made = made.map_err(|error| in_pass(resources, error))?;
    let group = group(resources, &made.layout, call)?;
    context.pass.set_pipeline(&made.pipeline);
    if let Some(group) = &group {
        context.pass.set_bind_group(0, group, &[]);
    }
    match call.work {
        Work::Draw(_) => {}
        Work::Dispatch(groups) => {
            check_groups(resources, &call.program.name, groups)?;
            let [x, y, z] = groups;
            context.pass.dispatch_workgroups(x, y, z);
        }
        Work::DispatchIndirect(arguments, offset) => {
            let arguments: BufferToken = arguments;
            context.pass.dispatch_workgroups_indirect(resources.buffer(arguments)?, offset);
        }
    }
    Ok(())
}

/// What the call binds; `None` where that is nothing.
fn group(
    resources: &Resources<'_>,
    layout: &wgpu::BindGroupLayout,
    call: &Declared,
) -> Result<Option<wgpu::BindGroup>, Error> {
    let entries = resources.calls().entries(call);
    let none = entries.len() == 0;
    // Made even of nothing, so that a shader that needs something says so.
    let group = resources.checked_group(layout, entries, &call.program)?;
    Ok((!none).then_some(group))
}

/// Gives a shader's error the name of the pass.
fn in_pass(resources: &Resources<'_>, error: Error) -> Error {
    match error {
        Error::Shader { shader, message } => {
            Error::Shader { shader, message: format!("pass `{}`: {message}", resources.pass_path()) }
        }
        error => error,
    }
}

fn check_groups(resources: &Resources<'_>, name: &str, groups: [u32; 3]) -> Result<(), Error> {
    let allowed = resources.device().limits().max_compute_workgroups_per_dimension;
    let most = groups.into_iter().max().unwrap_or(0);
    crate::pool::limit(name, "max_compute_workgroups_per_dimension", most.into(), allowed.into())
}
