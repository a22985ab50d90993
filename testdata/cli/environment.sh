# What GL drivers read from the environment changes no byte of a picture, and ends no tool.
cp "$fixtures/vase.meso" .
cat >.drirc <<'END'
<driconf><device><application name="all"><option name="pp_nored" value="1"/>
<option name="force_glsl_version" value="110"/></application></device></driconf>
END
set -- GALLIUM_DRIVER=softpipe GALLIUM_HUD=fps GALLIUM_NOOP=1 GALLIUM_NOSSE=1 GALLIUM_OVERRIDE_CPU_CAPS=sse2 \
    GALLIUM_THREAD=0 GALLIUM_TRACE=trace.xml GALLIVM_DEBUG=nopt GALLIVM_PERF=nopt,no_filter_hacks,no_opt \
    LP_DEBUG=mem LP_NATIVE_VECTOR_WIDTH=64 LP_NO_RAST=1 LP_NUM_THREADS=9999 \
    LP_PERF=no_depth,no_tex,no_blend,no_mipmap,no_linear,texmem \
    MESA_DEBUG=context MESA_EXTENSION_OVERRIDE=-GL_ARB_direct_state_access MESA_EXTENSION_MAX_YEAR=1999 \
    MESA_GLSL=nopt,dump MESA_GLSL_VERSION_OVERRIDE=110 MESA_GL_VERSION_OVERRIDE=2.1 MESA_INFO=1 \
    MESA_LOADER_DRIVER_OVERRIDE=zink MESA_LOG_FILE=mesa.log MESA_NO_ERROR=1 MESA_SHADER_CACHE_DIR=cache \
    MESA_SHADER_CACHE_DISABLE=0 MESA_SHADER_READ_PATH=. MESA_VERBOSE=all \
    DRAW_USE_LLVM=0 DRAW_FSE=1 ST_DEBUG=mesa,precompile NIR_DEBUG=print TGSI_PRINT_SANITY=1 INTEL_BLACKHOLE_DEFAULT=1 \
    EGL_PLATFORM=x11 EGL_LOG_LEVEL=debug LIBGL_ALWAYS_SOFTWARE=0 LIBGL_DEBUG=verbose DISPLAY=:99 DRI_PRIME=1 \
    XDG_CONFIG_HOME=. XDG_CACHE_HOME=cache HOME=. vblank_mode=3 force_glsl_version=110 glsl_zero_init=true \
    mesa_glthread=true mesa_no_error=true pp_nored=1 pp_celshade=1 pp_jimenezmlaa=8 \
    __GL_FSAA_MODE=9 __GL_SINGLETHREADED=1 __GLVND_APP_ERROR_CHECKING=1 __GLVND_DISALLOW_PATCHING=1

# draw MAKER SETTING...: the pictures are called the same, as their provenance holds the command line.
draw() {
    maker=$1
    shift
    env "$@" meso-render -q --context "$maker" --size 64x48 --png x.png vase.meso -o x.exr || echo "$maker: status $?"
}
# same MAKER SETTING...
same() {
    draw "$@"
    cmp plain.png x.png && cmp plain.exr x.exr || echo "with $2"
    rm -f x.png x.exr
}
for maker in osmesa egl; do
    meso-render -q --context $maker --size 64x48 --png x.png vase.meso -o x.exr 2>said || continue
    mv x.png plain.png
    mv x.exr plain.exr
    same $maker "$@"
    [ $maker = egl ] || same $maker LP_PERF=no_depth,no_tex
done
ls

# Where EGL has no driver, what was tried is said.
__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere/none.json meso-render --context egl --size 8x8 vase.meso -o x.exr 2>said
echo "status $?, $(grep -o 'EGL lists no devices; surfaceless: .* said' said)"
