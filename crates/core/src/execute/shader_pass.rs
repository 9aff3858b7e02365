//! Recording shader passes.

use crate::context::{BodyResult, ComputeContext, RenderContext, Resources};
use crate::error::Error;
use crate::handle::BufferToken;
use crate::pool::check_limit;
use crate::shader_pass::{Command, ShaderPassDecl};

/// Records a shader pass into an open render pass.
pub(super) fn draw(context: &mut RenderContext<'_>, index: u32) -> BodyResult {
    let resources = &context.resources;
    let Some(declared) = resources.shader_passes().get(index) else { return Ok(()) };
    let Command::Draw(targets) = &declared.command else { return Ok(()) };
    let cached = resources.caches().pipelines.render(resources.device(), &declared.stage, targets);
    let cached = cached.map_err(|error| in_pass(resources, error))?;
    let group = bind_group(resources, &cached.layout, declared)?;
    context.pass.set_pipeline(&cached.pipeline);
    if let Some(group) = &group {
        context.pass.set_bind_group(0, group, &[]);
    }
    context.pass.draw(0..3, 0..1);
    context.report_draws(1);
    Ok(())
}

/// Records a shader pass into an open compute pass.
pub(super) fn dispatch(context: &mut ComputeContext<'_>, index: u32) -> BodyResult {
    let resources = &context.resources;
    let Some(declared) = resources.shader_passes().get(index) else { return Ok(()) };
    let cached = resources.caches().pipelines.compute(resources.device(), &declared.stage);
    let cached = cached.map_err(|error| in_pass(resources, error))?;
    let group = bind_group(resources, &cached.layout, declared)?;
    context.pass.set_pipeline(&cached.pipeline);
    if let Some(group) = &group {
        context.pass.set_bind_group(0, group, &[]);
    }
    match declared.command {
        Command::Draw(_) => {}
        Command::Dispatch(workgroups) => {
            check_workgroups(resources, &declared.stage.name, workgroups)?;
            let [x, y, z] = workgroups;
            context.pass.dispatch_workgroups(x, y, z);
        }
        Command::DispatchIndirect(arguments, offset) => {
            let arguments: BufferToken = arguments;
            context.pass.dispatch_workgroups_indirect(resources.buffer(arguments)?, offset);
        }
    }
    Ok(())
}

/// Returns the bind group of a shader pass; `None` if it binds nothing.
fn bind_group(
    resources: &Resources<'_>,
    layout: &wgpu::BindGroupLayout,
    declared: &ShaderPassDecl,
) -> Result<Option<wgpu::BindGroup>, Error> {
    let bindings = resources.shader_passes().bindings(declared);
    let none = bindings.len() == 0;
    // An empty group is created too, so that a shader with bindings is an error.
    let group = resources.checked_group(layout, bindings, &declared.stage)?;
    Ok((!none).then_some(group))
}

/// Adds the name of the pass to a shader's error.
fn in_pass(resources: &Resources<'_>, error: Error) -> Error {
    match error {
        Error::Shader { shader, message } => {
            Error::Shader { shader, message: format!("pass {}: {message}", resources.pass_name()) }
        }
        error => error,
    }
}

fn check_workgroups(resources: &Resources<'_>, name: &str, workgroups: [u32; 3]) -> Result<(), Error> {
    let allowed = resources.device().limits().max_compute_workgroups_per_dimension;
    let most = workgroups.into_iter().max().unwrap_or(0);
    check_limit(name, "max_compute_workgroups_per_dimension", most.into(), allowed.into())
}
