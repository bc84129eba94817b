//! One function made into machine code, and the memory it stands in.

use std::sync::Mutex;

use cranelift_codegen::Context;
use cranelift_codegen::ir::{AbiParam, Function, InstBuilder, Signature, UserFuncName, Value, types};
use cranelift_codegen::isa::OwnedTargetIsa;
use cranelift_codegen::settings::{self, Configurable};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{Linkage, Module, default_libcall_names};

use super::emit::Emitter;

/// A function in memory that is given back when this is dropped.
pub struct Compiled {
    /// Its first instruction; valid as long as `self`.
    entry: *const u8,
    /// Holds the memory; nothing is changed in it any more.
    module: Mutex<Option<JITModule>>,
}

// SAFETY: the instructions behind `entry` are only read from the moment they are finished, and belong to no thread.
unsafe impl Send for Compiled {}
// SAFETY: as above.
unsafe impl Sync for Compiled {}

/// Options of the compiler. It leaves the order of operations as written: that fits the few registers better. Large frames
/// touch their pages one after the other, so that a stack that is too small is noticed.
const OPTIONS: [(&str, &str); 6] = [
    ("opt_level", "none"),
    ("enable_verifier", if cfg!(debug_assertions) { "true" } else { "false" }),
    ("enable_probestack", "true"),
    ("probestack_strategy", "inline"),
    ("use_colocated_libcalls", "false"),
    ("is_pic", "false"),
];

fn processor() -> Option<OwnedTargetIsa> {
    let mut flags = settings::builder();
    for (name, value) in OPTIONS {
        flags.set(name, value).ok()?;
    }
    cranelift_native::builder().ok()?.finish(settings::Flags::new(flags)).ok()
}

impl Compiled {
    /// Makes a function of `arrays` addresses that returns a number. `body` writes its instructions, given its arguments, and
    /// returns the result. Nothing where no code can be made for this processor, or the system allows no memory for it.
    pub fn new(arrays: usize, body: impl FnOnce(&mut Emitter, &[Value]) -> Value) -> Option<Self> {
        let isa = processor()?;
        let (convention, address) = (isa.default_call_conv(), isa.pointer_type());
        let mut signature = Signature::new(convention);
        signature.params.resize(arrays, AbiParam::new(address));
        signature.returns.push(AbiParam::new(types::F64));
        let mut module = JITModule::new(JITBuilder::with_isa(isa, default_libcall_names()));
        let id = module.declare_function("function", Linkage::Local, &signature).ok()?;
        let mut context = Context::for_function(Function::with_name_signature(UserFuncName::user(0, 0), signature));
        let mut room = FunctionBuilderContext::new();
        let mut builder = FunctionBuilder::new(&mut context.func, &mut room);
        let block = builder.create_block();
        builder.append_block_params_for_function_params(block);
        builder.switch_to_block(block);
        builder.seal_block(block);
        let arguments = builder.block_params(block).to_vec();
        let result = body(&mut Emitter::new(&mut builder, convention, address), &arguments);
        builder.ins().return_(&[result]);
        builder.finalize();
        module.define_function(id, &mut context).ok()?;
        module.finalize_definitions().ok()?;
        let entry = module.get_finalized_function(id);
        Some(Self { entry, module: Mutex::new(Some(module)) })
    }

    /// The function's first instruction, valid as long as this is not dropped.
    #[inline(always)]
    pub fn entry(&self) -> *const u8 {
        self.entry
    }
}

impl Drop for Compiled {
    fn drop(&mut self) {
        let module = self.module.get_mut().ok().and_then(Option::take);
        if let Some(module) = module {
            // SAFETY: the function is only called through `&self`, which nobody has any more.
            unsafe { module.free_memory() };
        }
    }
}
