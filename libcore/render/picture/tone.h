/* From light, linear and without bound, to what a screen shows, 0 to 1 and still linear. */
#ifndef MESO_TONE_H
#define MESO_TONE_H

typedef enum MesoTone {
    MESO_TONE_SHOULDER,     /* each channel as it is up to 3/4, then a hyperbola of the same slope that ends in white */
    MESO_TONE_NONE,         /* cut off at white */
    MESO_TONE_NEUTRAL,      /* "Khronos PBR Neutral Tone Mapper" (2024): colours of materials as they are */
    MESO_TONE_AGX,          /* AgX (Sobotka), by the fit of "Minimal AgX Implementation" (Wrensch 2023) */
    MESO_TONE_FILMIC        /* ACES' reference and output transforms, by Hill's fit ("BakingLab", 2016) */
} MesoTone;

/* `out` may be `color`; negative light counts as none. */
void meso_tone(MesoTone tone, const float color[3], float out[3]);

#endif
