"""forest.py TRAIN.csv: cross-validates a random forest (Debian: python3-sklearn) on the features of a model, the two
trivial baselines and Palpate's fit, with the folds of the fit. Takes minutes for a long recording."""
import sys

from sklearn.ensemble import RandomForestRegressor

import palpate


def main(train):
    rec = palpate.read_recording(train)
    model = palpate.fit([rec])
    features = model.features(rec["time_s"], rec["position_m"])
    folds = palpate.find_folds(features[:, 0])
    simple = palpate.baselines.features(rec)
    compared = {"bins": (simple, palpate.baselines.Bins()), "ridge": (simple, palpate.baselines.Ridge()),
                "random forest": (features, RandomForestRegressor(100, min_samples_leaf=5, n_jobs=-1, random_state=1)),
                "palpate": ([rec], palpate.Estimator())}
    print("folds: %d; features: %s" % (folds.max() + 1, ", ".join(model.feature_names)))
    for name, (known, estimator) in compared.items():
        result = palpate.cross_validate(known, rec["force_N"], estimator, folds)
        print("%-14s %5.1f %% within the JND, RMS error %.1f mN"
              % (name, 100 * result.within_jnd, 1e3 * result.rms_error_N))


if __name__ == "__main__":
    main(*sys.argv[1:])
